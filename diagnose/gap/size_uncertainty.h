/// Standard deviations of what is told of a fit's common parameters.
///
/// That of the fit's own model, noise and remainder alike, or what the clips say of it by how their scores scatter,
/// whichever is larger:
///
///     C = N⁻¹,      C_clips = N⁻¹ (n/(n - 1) sum over n clips of s s' + statements) N⁻¹
///
/// with N the normal matrix of the common parameters, each motion's own projected out (fit_neighbourhood.h), and s what
/// a clip's residuals pull at the minimum. With one clip its motions stand for clips; with one motion C is all there
/// is. Units are those of the parameters.
#pragma once

#include <Eigen/Core>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

class SizeUncertainty {
 public:
  /// `fit` is linearised with the noise of `set`.
  SizeUncertainty(const TrackSet& set, const MotionFit& fit);

  /// Of a quantity with these derivatives by the common parameters.
  double sd(const Eigen::VectorXd& by) const;
  /// Of one of the common parameters.
  double sd(Eigen::Index global) const;

 private:
  Eigen::MatrixXd model_, between_clips_;
};

}  // namespace glidelab::diagnose
