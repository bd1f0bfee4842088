#include "core/result/jackknife.h"

#include <algorithm>
#include <cassert>

#include "core/result/estimate.h"

namespace glidelab::core {

bool widen_by_jackknife(const std::vector<Eigen::Vector2d>& moved, LineUncertainty& parts) {
  assert(moved.size() >= 3);
  const auto n = static_cast<double>(moved.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& by : moved) covariance += by * by.transpose() * ((n - 1.0) / n);
  if (covariance(1, 1) <= chi2_ratio_limit(n - 1.0) * parts.var_a0 &&
      covariance(0, 0) <= chi2_ratio_limit(n - 1.0) * parts.var_k) {
    return false;
  }
  parts.var_k = std::max(covariance(0, 0), parts.var_k);
  parts.cov = covariance(0, 1);
  parts.var_a0 = std::max(covariance(1, 1), parts.var_a0);
  parts.degrees = n - 2.0;
  return true;
}

}  // namespace glidelab::core
