/// The median of some numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace glidelab::core {

/// The upper one of the two middle values where their number is even; there must be at least one.
inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace glidelab::core
