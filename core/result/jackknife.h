/// Delete-one jackknife of a line: how far leaving out each of n parts of its points moves it.
///
///     cov = (n - 1)/n sum d_i d_i^T      d_i: change of (K/m, a0) without part i
#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/result/results.h"

namespace glidelab::core {

/// Takes the jackknife's covariance into `parts` where a variance of it is larger than chance makes it
/// (chi2_ratio_limit); variances only grow, and n - 2 degrees of freedom are left. Whether it did. Asserts n >= 3.
bool widen_by_jackknife(const std::vector<Eigen::Vector2d>& moved, LineUncertainty& parts);

}  // namespace glidelab::core
