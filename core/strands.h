/// Sums in four strands: additions that need not wait for each other, and that a compiler turns into vectors.
#pragma once

#include <array>
#include <cstddef>

namespace glidelab::core {

/// Sums of kSums terms for each of `count` numbers; `terms(i)` is an array of them.
template <std::size_t kSums, class Terms>
[[gnu::always_inline]] inline std::array<double, kSums> sums_in_strands(std::size_t count, const Terms& terms) {
  constexpr std::size_t kStrands = 4;
  std::array<std::array<double, kStrands>, kSums> strands{};
  const std::size_t whole = count - count % kStrands;
  for (std::size_t i = 0; i < whole; i += kStrands) {
    for (std::size_t k = 0; k < kStrands; ++k) {
      const std::array<double, kSums> term = terms(i + k);
      for (std::size_t s = 0; s < kSums; ++s) strands[s][k] += term[s];
    }
  }
  for (std::size_t i = whole; i < count; ++i) {
    const std::array<double, kSums> term = terms(i);
    for (std::size_t s = 0; s < kSums; ++s) strands[s][i - whole] += term[s];
  }
  std::array<double, kSums> sums{};
  for (std::size_t s = 0; s < kSums; ++s) {
    sums[s] = (strands[s][0] + strands[s][1]) + (strands[s][2] + strands[s][3]);
  }
  return sums;
}

}  // namespace glidelab::core
