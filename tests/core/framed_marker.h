/// A square marker as AprilTag and ArUco print it, for the tests of core/: a black frame with six by six cells inside,
/// on white paper.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace glidelab::tests {

inline constexpr double kPaperOfFrame = 1.25;  ///< its half side over that of the black square

/// Its light at an offset from the centre, in half sides of the black square; negative outside the paper.
inline double framed_marker(double x, double y) {
  constexpr double kInk = 0.03, kPaper = 0.8;
  constexpr std::array<unsigned, 6> kRows = {0b101101, 0b001001, 0b110100, 0b000111, 0b011000, 0b100110};
  const double out = std::max(std::abs(x), std::abs(y));
  if (out > kPaperOfFrame) return -1.0;
  if (out > 1.0) return kPaper;
  if (out > 0.75) return kInk;
  const auto column = static_cast<unsigned>(std::clamp((x + 0.75) * 4.0, 0.0, 5.0));
  const auto row = static_cast<std::size_t>(std::clamp((y + 0.75) * 4.0, 0.0, 5.0));
  return (kRows[row] >> column & 1U) != 0 ? kPaper : kInk;
}

}  // namespace glidelab::tests
