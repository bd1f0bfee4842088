/// Sums and means of numbers given by their logarithms.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace glidelab::base {

/// log of the sum of exp(logs); logs is not empty.
inline double log_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  if (!std::isfinite(most)) return most;
  double sum = 0.0;
  for (const double log : logs) sum += std::exp(log - most);
  return most + std::log(sum);
}

/// log of the mean of exp(logs); logs is not empty.
inline double log_mean(const std::vector<double>& logs) {
  return log_sum(logs) - std::log(static_cast<double>(logs.size()));
}

}  // namespace glidelab::base
