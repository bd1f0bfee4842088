/// Gaps in the times of a clip that no motion bridges.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/math/quantile.h"

namespace glidelab::core {

/// The longest step between two times of one clip, in median steps: 1000 s at 100 Hz. Smoothing treats the clip as a
/// series of such steps; a longer gap separates two recordings or is due to a wrong time.
inline constexpr double kLongestGapSteps = 1e5;

struct TimeGap {
  std::size_t after = 0;  ///< index of the time after it
  double gap_s = 0.0;
  double longest_s = 0.0;  ///< the longest allowed
};

/// The first gap that is too long; empty if there is none. Times rise.
inline std::optional<TimeGap> too_long_gap(std::span<const double> t_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t_s.size(); ++i) steps.push_back(t_s[i] - t_s[i - 1]);
  const double longest_s = kLongestGapSteps * quantile(steps, 0.5);
  const auto found = std::find_if(steps.begin(), steps.end(), [&](double step) { return step > longest_s; });
  if (found == steps.end()) return std::nullopt;
  return TimeGap{static_cast<std::size_t>(found - steps.begin()) + 1, *found, longest_s};
}

}  // namespace glidelab::core
