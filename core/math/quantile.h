/// Quantiles of a sample, and the time step of a series.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "base/math/distributions.h"

namespace glidelab::core {

using base::kNormal95;

/// Standard deviation of normal numbers about zero over the median of their magnitudes: 1 over the 0.75 quantile.
inline constexpr double kSdOverMedian = 1.0 / 0.674489750196082;

/// The value below which the given fraction of the numbers lies (the lower of two neighbours); 0 if there are none.
inline double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The median: the upper of the two middle values if their number is even; there must be at least one.
inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The median step between rising times; 0 for fewer than two.
inline double median_step(std::span<const double> t_s) {
  std::vector<double> steps;
  steps.reserve(t_s.size());
  for (std::size_t i = 1; i < t_s.size(); ++i) steps.push_back(t_s[i] - t_s[i - 1]);
  return quantile(std::move(steps), 0.5);
}

/// Whether all steps are alike to a tenth: a file of constant rate, or a table of every frame.
inline bool has_even_steps(std::span<const double> t_s, double step_s) {
  constexpr double kMostUneven = 0.1;  // of the step
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    if (std::abs(t_s[i] - t_s[i - 1] - step_s) > kMostUneven * step_s) return false;
  }
  return step_s > 0.0;
}

}  // namespace glidelab::core
