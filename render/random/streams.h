/// The uses of random numbers, so that no two uses draw the same ones.
///
/// A random word is a function of the seed and of a counter {first, second, third, purpose} (random_numbers.h). Every
/// purpose has its own number in the last place; the stream in the third place distinguishes clips and stills.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "render/random/random_numbers.h"

namespace glidelab::render {

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
