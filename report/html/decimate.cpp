#include "report/html/decimate.h"

#include <algorithm>
#include <numeric>

namespace glidelab::report {

std::vector<std::size_t> outline(std::span<const double> y, std::size_t most) {
  std::vector<std::size_t> kept;
  if (y.size() <= std::max<std::size_t>(most, 4)) {
    kept.resize(y.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const std::size_t parts = std::max<std::size_t>(most / 2, 1);
  kept.push_back(0);
  for (std::size_t part = 0; part < parts; ++part) {
    const auto from = y.begin() + static_cast<std::ptrdiff_t>(y.size() * part / parts);
    const auto to = y.begin() + static_cast<std::ptrdiff_t>(y.size() * (part + 1) / parts);
    const auto [low, high] = std::minmax_element(from, to);
    const auto first = static_cast<std::size_t>(std::min(low, high) - y.begin());
    const auto second = static_cast<std::size_t>(std::max(low, high) - y.begin());
    if (first != kept.back()) kept.push_back(first);
    if (second != kept.back()) kept.push_back(second);
  }
  if (kept.back() != y.size() - 1) kept.push_back(y.size() - 1);
  return kept;
}

std::vector<std::size_t> every_nth(std::size_t count, std::size_t most) {
  std::vector<std::size_t> kept;
  if (count <= most || most < 2) {
    kept.resize(std::min(count, std::max<std::size_t>(most, 1)));
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  for (std::size_t i = 0; i < most; ++i) kept.push_back(i * (count - 1) / (most - 1));
  return kept;
}

}  // namespace glidelab::report
