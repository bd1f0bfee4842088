/// Random numbers as a function of a counter and a key, with no state: what they are drawn for, Philox4x32-10, the
/// words of a row of pixels, normal and Poisson deviates.
///
/// Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC '11.
/// Ten rounds of two 32 x 32 -> 64 bit multiplications; passes TestU01's BigCrush. Every value is a pure function of
/// its inputs, so that it is the same in any order and on any number of threads. RandomPurpose, first below, lists what
/// random numbers are drawn for.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/math/simd.h"

namespace glidelab::render {

/// The uses of random numbers, so that no two uses draw the same ones.
///
/// A random word is a function of the seed and of a counter {first, second, third, purpose}. Every purpose has its own
/// number in the last place; the stream in the third place distinguishes clips and stills.
///
/// Files of a seed stay the same only as long as these numbers do.
enum class RandomPurpose : std::uint32_t {
  pixel_noise = 0,        ///< normal deviates of shot and read noise: {block, frame, stream}
  exact_pixel_noise = 1,  ///< Poisson numbers of dark pixels: {pixel, frame, stream}
  fixed_pattern = 2,      ///< differences among a sensor's pixels: {pixel, 0, 0}
  frame_clock = 3,        ///< jitter, dropped and repeated frames: {slot, 0, stream}
  pattern_poses = 4,      ///< poses of the calibration's boards: {view, number, 0}
  // Of a sweep's design, all {index low, index high, axis}:
  sweep_seed = 0x5eed,     ///< the seed of a run
  sweep_draw = 0xd4a3,     ///< the value of a random axis
  sweep_stratum = 0x57a7,  ///< the place within a stratum
  sweep_shift = 0x5b0b,    ///< the shift of a low-discrepancy sequence
  sweep_permute = 0xfe15,  ///< the order of strata
};

inline constexpr std::array kRandomPurposes = {RandomPurpose::pixel_noise,   RandomPurpose::exact_pixel_noise,
                                               RandomPurpose::fixed_pattern, RandomPurpose::frame_clock,
                                               RandomPurpose::pattern_poses, RandomPurpose::sweep_seed,
                                               RandomPurpose::sweep_draw,    RandomPurpose::sweep_stratum,
                                               RandomPurpose::sweep_shift,   RandomPurpose::sweep_permute};

/// Streams: clips are numbered from 0, stills from here.
inline constexpr std::uint32_t kFirstStillStream = 0x40000000u;

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

inline constexpr std::uint32_t kPhiloxM0 = 0xD2511F53u;
inline constexpr std::uint32_t kPhiloxM1 = 0xCD9E8D57u;
inline constexpr std::uint32_t kPhiloxW0 = 0x9E3779B9u;  // golden ratio
inline constexpr std::uint32_t kPhiloxW1 = 0xBB67AE85u;  // sqrt(3) - 1
inline constexpr int kPhiloxRounds = 10;

/// Four random words.
constexpr PhiloxCounter philox(PhiloxCounter counter, PhiloxKey key) {
  for (int round = 0; round < kPhiloxRounds; ++round) {
    const std::uint64_t product0 = std::uint64_t{kPhiloxM0} * counter[0];
    const std::uint64_t product1 = std::uint64_t{kPhiloxM1} * counter[2];
    counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(product1),
               static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(product0)};
    key[0] += kPhiloxW0;
    key[1] += kPhiloxW1;
  }
  return counter;
}

constexpr PhiloxKey philox_key(std::uint64_t seed) {
  return {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
}

/// A uniform number from a word, in steps of 2^-32, above 0 and below 1.
constexpr double uniform_of(std::uint32_t word) {
  return (word + 0.5) / 4294967296.0;
}

inline constexpr int kBlocks = 8;
inline constexpr int kGroup = 4 * kBlocks;  // pixels

using base::Simd;

struct RowNoise {
  std::uint32_t frame;
  std::uint32_t stream;
  PhiloxKey key;
};

/// The random words of a row of pixels: Philox4x32-10, in groups of 32 pixels of 8 blocks each (sensor.h describes
/// their use).
///
/// Words of the blocks first_block, first_block + 1, …, 8 blocks a group, into `words` (32 a group): word j of block b
/// of group g at 32 g + 8 j + b. RandomPurpose::pixel_noise.
void row_words(std::uint32_t first_block, int groups, const RowNoise& noise, std::uint32_t* words, Simd simd);

/// sin(2 pi x), for an angle x in turns, |x| <= 1/4; minimax of degree 7, error 6e-7.
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

/// The parts of two normal deviates, sqrt(square) cosine and sqrt(square) sine: the root of square times a variance
/// takes one root, not two.
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

/// Two normal deviates from two random words, by the Box-Muller method in single precision: at most 5.9 standard
/// deviations. Only IEEE-exact operations, so that every vectorisation gives the same bits.
inline NormalPair normal_pair(std::uint32_t word0, std::uint32_t word1) {
  const PolarPair pair = polar_pair(word0, word1);
  const float radius = std::sqrt(pair.square);
  return {radius * pair.cosine, radius * pair.sine};
}

/// Exact Poisson numbers for small means, from two uniform words each.
///
/// Poisson(mean) is the sum of Poisson(n), with n the integer part of the mean, and Poisson(the rest): the first by
/// inversion of a tabulated distribution (found through a guide, so that it takes a few steps at any mean), the second
/// by sequential inversion. Exact to the 2^-32 of a uniform word.
class PoissonTable {
 public:
  /// For means in [0, largest_mean).
  explicit PoissonTable(int largest_mean);
  int draw(double mean, std::uint32_t whole_word, std::uint32_t rest_word) const;

 private:
  struct Distribution {
    std::vector<double> below;         ///< P(N <= k)
    std::vector<std::uint16_t> guide;  ///< the k at which to start, by the word's upper 8 bits
  };
  std::vector<Distribution> whole_;
};

/// Four random words.
constexpr PhiloxCounter random_words(RandomPurpose purpose, const std::array<std::uint32_t, 3>& counter,
                                     PhiloxKey key) {
  return philox({counter[0], counter[1], counter[2], static_cast<std::uint32_t>(purpose)}, key);
}

/// No two values of the list are equal.
template <typename T, std::size_t n>
constexpr bool all_distinct(const std::array<T, n>& values) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (values[i] == values[j]) return false;
    }
  }
  return true;
}
static_assert(all_distinct(kRandomPurposes), "two purposes would draw the same random numbers");

}  // namespace glidelab::render
