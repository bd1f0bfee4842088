/// The uncertainty of a fit of the whole motion (trajectory_fit.h): the noise's covariance, what residuals scatter
/// beyond it, and what errors of the camera and the scale do.
///
/// With P the derivatives by the common parameters without the part that a block's own start can take up, and H = sum
/// of P'P / s^2: covariance H^-1 [sum of P' Gamma P / s^4] H^-1, widened as trajectory_fit.h says. Where there are four
/// blocks or more they are left out one at a time (the jackknife, to first order: -(H - H_b)^-1 P_b' r_b / s^2), and
/// that covariance, which knows of no noise model (rounded positions that move slowly err together), counts where one
/// of its variances is above the other's by more than chance makes it (chi2_ratio_limit, n - 1 degrees of freedom).
#pragma once

#include <Eigen/Core>

#include <vector>

#include "fit/trajectory/trajectory_model.h"

namespace glidelab::fit {

inline constexpr double kLeastVariance = 1e-24;  // m²: positions without noise

/// One block's residuals (measured - model) and their derivatives by the common parameters and by (x0, v0).
struct Linearised {
  Eigen::VectorXd residual;
  Eigen::MatrixXd common;  ///< n x 3
  Eigen::MatrixXd start;   ///< n x 2

  void scale_rows(const Eigen::VectorXd& by) {
    residual.array() *= by.array();
    common.array().colwise() *= by.array();
    start.array().colwise() *= by.array();
  }
};

/// Variance of the noise of one position of the block.
double variance_of(const FitBlock& fit);

class TrajectoryUncertainty {
 public:
  /// At the minimum; all of it must outlive this.
  TrajectoryUncertainty(const std::vector<FitBlock>& blocks, const std::vector<Linearised>& at, int free);

  bool determined() const { return inverse_.size() > 0; }
  /// Sets the covariance with its degrees of freedom, the scatter, the number of points and the shared changes.
  void fill(TrajectoryFit& fit) const;

 private:
  void add_misfit(double count, double ratio, TrajectoryFit& fit) const;
  void compare_with_jackknife(TrajectoryFit& fit) const;
  void add_shared(TrajectoryFit& fit) const;

  const std::vector<FitBlock>& blocks_;
  const std::vector<Linearised>& at_;
  std::vector<Eigen::MatrixXd> projected_;
  Eigen::MatrixXd normal_, inverse_;
};

}  // namespace glidelab::fit
