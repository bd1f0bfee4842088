/// Two normal deviates of two random words, by Box and Muller's method in single precision: at most 5.9 standard
/// deviations. Only IEEE-exact operations, so that every way to vectorise it gives the same bits.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace glidelab::render {

/// 2 pi of an angle given in turns, as sine: |x| <= 1/4; minimax of degree 7, error 6e-7.
inline float sine_of_turns(float x) {
  const float q = x * x;
  return x * (6.28316404f + q * (-41.3371423f + q * (81.3407651f + q * -70.9933988f)));
}

/// Natural logarithm of 0 < x < 2; minimax of degree 6 in the mantissa from sqrt(1/2) to sqrt(2), error 1.5e-6.
inline float log_of(float x) {
  constexpr std::int32_t kRootHalf = 0x3F3504F3;  // the bits of sqrt(1/2)
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - kRootHalf) >> 23;
  const float m = std::bit_cast<float>(bits - (exponent << 23)) - 1.0f;
  const float polynomial =
      1.00001278f +
      m * (-0.499850506f + m * (0.332258767f + m * (-0.25472486f + m * (0.223300294f + m * -0.14319701f))));
  return static_cast<float>(exponent) * 0.693147181f + m * polynomial;
}

/// The parts of two normal deviates, sqrt(square) cosine and sqrt(square) sine: the root of square times a variance is
/// one root, not two.
struct PolarPair {
  float square;
  float cosine;
  float sine;
};

inline PolarPair polar_pair(std::uint32_t word0, std::uint32_t word1) {
  constexpr float kBit = 1.0f / 16777216.0f;  // 2^-24
  const float u = (static_cast<float>(static_cast<std::int32_t>(word0 >> 8)) + 0.5f) * kBit;
  const float turns = static_cast<float>(static_cast<std::int32_t>(word1) >> 8) * kBit;  // [-1/2, 1/2)
  const float square = -2.0f * log_of(u);  // not negative: u <= 1, and the polynomial of log_of is positive
  const float away = std::fabs(turns);
  const float folded = 0.25f - std::fabs(away - 0.25f);
  return {square, sine_of_turns(0.25f - away), std::copysign(sine_of_turns(folded), turns)};
}

struct NormalPair {
  float z0;
  float z1;
};

/// Two normal deviates of two words (Box and Muller).
inline NormalPair normal_pair(std::uint32_t word0, std::uint32_t word1) {
  const PolarPair pair = polar_pair(word0, word1);
  const float radius = std::sqrt(pair.square);
  return {radius * pair.cosine, radius * pair.sine};
}

}  // namespace glidelab::render
