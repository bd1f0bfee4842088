/// Standard deviations of the stated values of a fit's common parameters.
///
/// The larger of two: that of the fit's own model, noise and remainder included, and that from the scatter of the
/// clips' scores:
///
///     C = N⁻¹,      C_clips = N⁻¹ (n/(n - 1) sum over n clips of s s' + statements) N⁻¹
///
/// with N the normal matrix of the common parameters, each motion's own projected out (fit_neighbourhood.h), and s the
/// score of a clip's residuals at the minimum. With one clip its motions stand in for clips; with one motion only C is
/// available. Units are those of the parameters.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

class SizeUncertainty {
 public:
  /// `fit` is linearised with the noise of `set`.
  SizeUncertainty(const TrackSet& set, const MotionFit& fit);

  /// Standard deviation of a quantity with these derivatives with respect to the common parameters.
  double sd(const Eigen::VectorXd& by) const;
  /// Standard deviation of one of the common parameters.
  double sd(Eigen::Index global) const;
  /// v' C⁻¹ v of these common parameters, C by the fit's own model: what they have in common with others, and is not
  /// determined, does not count.
  double chi2(const std::vector<Eigen::Index>& globals, const Eigen::VectorXd& values) const;

 private:
  Eigen::MatrixXd model_, between_clips_;
};

}  // namespace glidelab::diagnose
