/// From light to codes in a sensor: fixed patterns, shot noise, read noise, saturation, gain, offset, quantisation.
///
///     expected  = light response_p + dark_p                     (of pixel p; fixed_pattern.h)
///     electrons = min(Poisson(expected), full well) + Normal(0, read noise) + offset_p
///     code      = round(gain electrons + offset), limited to 0 … 2^bits - 1 as a converter does
///
/// Source: EMVA standard 1288 (linear model); light is in electrons, photons times quantum efficiency, which is exact
/// (a Poisson number thinned is a Poisson number). What comes after the converter is in readout.h. From kNormalMean
/// expected electrons on, and where the full well is six standard deviations away, the Poisson number and the read
/// noise are one normal deviate of the variance of both; else the Poisson number is exact.
///
/// Random numbers are Philox4x32-10 with the key {seed low, seed high} (streams.h). Normal deviates
/// (RandomPurpose::pixel_noise): a row is cut into groups of 32 pixels, each group into 8 blocks, numbered row by row
/// through the image; word pairs (0, 1) and (2, 3) of a block give two deviates each by Box and Muller's method (24
/// bits of each word, so at most 5.9 standard deviations), and deviate j of block b belongs to pixel 8 j + b of its
/// group. The exact path (exact_pixel_noise): the words of a pixel are those of its Poisson number (2) and of the read
/// noise's pair. So a pixel is the same in any order, on any number of threads, and in any part of the image that is
/// asked for; and the same with and without AVX2 (only IEEE-exact operations, never contracted).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "render/image/float_picture.h"
#include "render/random/noise_words.h"
#include "render/sensor/fixed_pattern.h"
#include "render/sensor/tone_curve.h"

namespace glidelab::render {

enum class Colour { mono, bayer };

struct Sensor {
  int bit_depth = 8;  ///< of the codes that come out, 8 to 16
  double full_well_e = 60000.0;
  double read_noise_e = 30.0;
  double gain_dn_per_e = 253.0 / 60000.0;  ///< codes of the converter
  double offset_dn = 2.0;                  ///< likewise
  std::optional<int> converter_bits = {};  ///< bit_depth, where not given; never less
  PixelSpread pixels = {};
  ToneCurve tone = {};  ///< from the converter's codes to those that come out
  Colour colour = Colour::mono;
  std::array<double, 3> colour_response = {0.55, 1.0, 0.65};  ///< red, green, blue to white light, beside the strongest

  int largest_code() const { return (1 << bit_depth) - 1; }
  int largest_converter_code() const { return (1 << converter_bits.value_or(bit_depth)) - 1; }
};

/// Which noise: the same key and pixel give the same number.
struct NoiseKey {
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;  ///< a clip or a view
  std::uint32_t frame = 0;
};

/// Mean number of electrons from which the Poisson distribution is taken as normal (its skewness is 1/16 there).
inline constexpr float kNormalMean = 256.0f;

/// The converter's codes of the pixels of `rect`, row by row, from the expected electrons of the whole image, without
/// colours. `codes` holds rect.width x rect.height; the 8-bit form is for converters of 8 bits. No pattern: all pixels
/// are alike. std::logic_error where sizes do not fit.
void read_out(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint8_t> codes, Simd simd = Simd::best, const FixedPattern* pattern = nullptr);
void read_out(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint16_t> codes, Simd simd = Simd::best, const FixedPattern* pattern = nullptr);

}  // namespace glidelab::render
