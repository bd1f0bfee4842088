/// What a fit of the whole motion (trajectory_fit.h) is given and what it finds.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "core/result/results.h"

namespace glidelab::fit {

/// A block with the noise of its clip.
struct FitBlock {
  const core::FreeBlock* block = nullptr;
  std::vector<double> autocovariance_m2;
  double scale_sd_relative = 0.0;
};

/// k, d, f; or k and the intercept d - direction f with f = 0 where there is one direction only.
struct TrajectoryFit {
  Eigen::VectorXd parameters;           ///< 3, or 2
  int direction = 0;                    ///< the only one, or 0 for both
  Eigen::MatrixXd covariance;           ///< random part
  std::vector<Eigen::VectorXd> shared;  ///< signed changes by one standard deviation of each shared error
  double degrees = 0.0;                 ///< of freedom of the covariance; infinite where it is as good as known
  double scatter = 0.0;                 ///< root mean square residual over the noise
  std::size_t points = 0;
  std::size_t left_out = 0;             ///< positions left out as outliers
  std::vector<Eigen::Vector2d> starts;  ///< x0, v0 of each block
  int iterations = 0;
};

}  // namespace glidelab::fit
