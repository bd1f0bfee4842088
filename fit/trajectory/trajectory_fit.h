/// The fit of the whole motion: equation (8) with its reversals to the measured positions themselves, no smoothing.
///
/// For all clips of one configuration at once, by least squares weighted with each clip's noise:
///
///     x_i = x(t_i; k, d, f, x0_b, v0_b) + noise,     dv/dt = d - k v - sign(v) f,     d = g sin(alpha),  f = mu g
///     cos(alpha)
///
/// with a start (x0, v0) for every block b of free motion. Levenberg and Marquardt's method with sensitivities that
/// carry the jump at v = 0 (sim/track_sensitivity.h), from several starts; the starts x0, v0 are eliminated block by
/// block. Where the noise is white and Gaussian this is the maximum of the likelihood, and its covariance the
/// Cramer-Rao bound.
///
/// Uncertainty: correlated noise by the sandwich H^-1 J'W Gamma W J H^-1; where the residuals are larger than the noise
/// explains (core::chi2_ratio_limit), the covariance of the scores of eight or more pieces of the motion is
/// added, with its degrees of freedom; the errors of the camera and the plane, and of the scale, are propagated as
/// signed shifts (trajectory_uncertainty.h).
///
/// Robust: from the least squares on, Huber's weights (1 up to 1.5 deviations, 1.5 over the deviations beyond; the
/// scale is 1.4826 times each block's median residual) until they settle, then least squares without the positions
/// that are off by more than 4 of these. Positions without outliers lose next to nothing by it (6 in 1e5 normal ones).
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "fit/trajectory/trajectory_model.h"

namespace glidelab::fit {

struct TrajectoryOptions {
  bool robust = false;
};

/// `start` holds k, d, f to begin with. Nothing where no start converges or the data do not determine the parameters.
std::optional<TrajectoryFit> fit_trajectories(const std::vector<FitBlock>& blocks, const Eigen::Vector3d& start,
                                              const TrajectoryOptions& options = {});

}  // namespace glidelab::fit
