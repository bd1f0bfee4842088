/// How smoothed motions respond to the rate k of their process, which follows the noise of the positions.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/motion/smoothing/parted_motion.h"
#include "core/motion/smoothing/smoothing_ensemble.h"
#include "core/motion/smoothing/smoothness_search.h"

namespace glidelab::core {

/// Derivatives by k of x, v and a of every node, and of x of every point of the input.
struct RateResponse {
  std::vector<std::vector<Eigen::Array3d>> nodes;
  std::vector<double> point_gain;  ///< dk / dy of every point: k is the most likely for these positions
};

/// k follows the noise of the positions as dk/dy_i = (sd k / s)^2 (dx_i/dk) / f_i^2, because the derivative of -log
/// likelihood by y is the residual over its variance.
template <int N>
RateResponse rate_response(const PartedMotion<N>& motion, const AtTau& at, double noise_variance) {
  constexpr double kStep = 0.5;  // standard deviations
  const MotionParts& parts = motion.parts();
  const double step = kStep * at.rate_sd_1_s;
  Smoothness how = at.how;
  how.rate_1_s = at.how.rate_1_s - step;
  const std::vector<ChainPosterior<N>> below = motion.posteriors(how);
  how.rate_1_s = at.how.rate_1_s + step;
  const std::vector<ChainPosterior<N>> above = motion.posteriors(how);
  RateResponse made;
  made.point_gain.assign(parts.input.t_s.size(), 0.0);
  std::vector<double> residual(parts.input.t_s.size(), 0.0);
  const double per_point = at.rate_sd_1_s * at.rate_sd_1_s / noise_variance;
  for (std::size_t p = 0; p < below.size(); ++p) {
    made.nodes.emplace_back();
    for (std::size_t k = 0; k < below[p].size(); ++k) {
      const Eigen::Array3d by = (above[p].mean(k) - below[p].mean(k)).template head<3>().array() / (2.0 * step);
      made.nodes.back().push_back(by);
      if (!below[p].node(k).point) continue;
      const std::size_t i = parts.parts[p].points.first + *below[p].node(k).point;
      const double factor = parts.input.noise_factor.empty() ? 1.0 : parts.input.noise_factor[i];
      made.point_gain[i] = per_point * by[0] / (factor * factor);
      const double middle = 0.5 * (above[p].mean(k)[0] + below[p].mean(k)[0]);
      residual[i] = (parts.input.x_m[i] - middle) / (factor * factor);
    }
  }
  // For these positions themselves the gain contributes nothing, so that rows still give the smoothed motion.
  double of_gain = 0.0, of_residual = 0.0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    of_gain += made.point_gain[i] * parts.input.x_m[i];
    of_residual += residual[i] * parts.input.x_m[i];
  }
  for (std::size_t i = 0; i < residual.size(); ++i) made.point_gain[i] -= of_gain / of_residual * residual[i];
  return made;
}

/// A row including the response of its motion to the noise through k, over all points.
inline KernelRow with_rate(const KernelRow& row, const Eigen::Array3d& by_rate, const std::vector<double>& point_gain) {
  KernelWeights weights{point_gain, point_gain, point_gain};
  const std::array<std::vector<double>*, 3> to{&weights.x, &weights.v, &weights.a};
  const std::array<const std::vector<double>*, 3> from{&row.weights->x, &row.weights->v, &row.weights->a};
  for (int d = 0; d < 3; ++d) {
    for (double& w : *to[d]) w *= by_rate[d];
    for (std::size_t i = 0; i < from[d]->size(); ++i) (*to[d])[row.first + i] += (*from[d])[i];
  }
  return {0, std::make_shared<const KernelWeights>(std::move(weights))};
}

}  // namespace glidelab::core
