/// What the sensor makes of light: shot noise, read noise, saturation, gain, offset, quantisation.
///
///     electrons = min(Poisson(expected), full well) + Normal(0, read noise)
///     code      = round(gain * electrons + offset), saturated at 0 and 2^bits - 1 as a converter does
///
/// Source: EMVA standard 1288 (linear model), without dark current and fixed patterns so far. From kNormalMean expected
/// electrons on, and where the full well is six standard deviations away, the Poisson number and the read noise are one
/// normal deviate of the variance of both; else the Poisson number is exact.
///
/// Random numbers are Philox4x32-10 with the key {seed low, seed high} and the counter {block, frame, stream, purpose}.
/// Purpose 0: normal deviates. A row is cut into groups of 32 pixels, each group into 8 blocks (numbered row by row
/// through the picture); word pairs (0, 1) and (2, 3) of a block give two deviates each by Box and Muller's method (24
/// bits of each word, so at most 5.9 standard deviations), and deviate j of block b belongs to pixel 8 j + b of its
/// group. Purpose 1: the exact path; block is the pixel's number in the picture, its words are Poisson (2), and the
/// read noise's pair. So a pixel is the same in any order, on any number of threads, and in any part of the picture
/// that is asked for; and the same with and without AVX2 (only IEEE-exact operations, never contracted).
#pragma once

#include <cstdint>
#include <span>

#include "render/picture.h"

namespace glidelab::render {

struct Sensor {
  int bit_depth = 8;  ///< 8 to 16
  double full_well_e = 60000.0;
  double read_noise_e = 30.0;
  double gain_dn_per_e = 253.0 / 60000.0;
  double offset_dn = 2.0;

  int largest_code() const { return (1 << bit_depth) - 1; }
};

/// Which noise: the same key and pixel give the same number.
struct NoiseKey {
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;  ///< a clip or a view
  std::uint32_t frame = 0;
};

/// Mean number of electrons from which the Poisson distribution is taken as normal (its skewness is 1/16 there).
inline constexpr float kNormalMean = 256.0f;

/// Which instructions; all give the same codes (a test compares them).
enum class Simd { best, baseline, portable };

/// Codes of the pixels of `rect`, row by row, from the expected electrons of the whole picture. `codes` holds
/// rect.width x rect.height; the 8-bit form is for bit_depth 8.
void read_out(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint8_t> codes, Simd simd = Simd::best);
void read_out(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint16_t> codes, Simd simd = Simd::best);

}  // namespace glidelab::render
