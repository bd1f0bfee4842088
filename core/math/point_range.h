/// Points that follow each other.
#pragma once

#include <cstddef>
#include <vector>

namespace glidelab::core {

struct PointRange {
  std::size_t from = 0;
  std::size_t to = 0;  ///< one past the last
  std::size_t size() const { return to - from; }
};

/// The longest ranges of equal value, in order; together they cover all points.
template <typename T>
std::vector<PointRange> ranges_of(const std::vector<T>& values) {
  std::vector<PointRange> ranges;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || values[i] != values[i - 1]) ranges.push_back({i, i});
    ranges.back().to = i + 1;
  }
  return ranges;
}

/// Sets the values of a range.
template <typename T>
void fill_range(std::vector<T>& values, const PointRange& range, const T& value) {
  for (std::size_t i = range.from; i < range.to; ++i) values[i] = value;
}

}  // namespace glidelab::core
