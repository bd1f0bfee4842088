/// From light to codes in a sensor: fixed patterns, shot noise, read noise, saturation, gain, offset, quantisation; and
/// the tone curve after it.
///
///     expected  = light response_p + dark_p                     (of pixel p; FixedPattern)
///     electrons = min(Poisson(expected), full well) + Normal(0, read noise) + offset_p
///     code      = round(gain electrons + offset), limited to 0 … 2^bits - 1 as in a converter
///
/// Source: EMVA standard 1288 (linear model); light is in electrons, photons times quantum efficiency, which is exact
/// (a Poisson number thinned is a Poisson number). What comes after the converter is in readout.h. From kNormalMean
/// expected electrons on, and if the full well is six standard deviations away, the Poisson number and the read noise
/// are combined in one normal deviate with the variance of both; otherwise the Poisson number is exact.
///
/// Random numbers are Philox4x32-10 with the key {seed low, seed high} (random_numbers.h). Normal deviates
/// (RandomPurpose::pixel_noise): a row is divided into groups of 32 pixels, each group into 8 blocks, numbered row by
/// row through the image; word pairs (0, 1) and (2, 3) of a block give two deviates each by the Box-Muller method (24
/// bits of each word, so at most 5.9 standard deviations), and deviate j of block b belongs to pixel 8 j + b of its
/// group. The exact path (exact_pixel_noise): the words of a pixel are those of its Poisson number (2) and of the read
/// noise's pair. So a pixel is the same in any order, on any number of threads, and in any requested part of the image;
/// it is also the same with and without AVX2 (only IEEE-exact operations, never contracted).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/image/float_image.h"
#include "render/random/random_numbers.h"

namespace glidelab::render {

/// From linear light to the codes of a video: the camera's transformation of the converter's codes before it writes
/// them.
///
///     linear   y = x
///     gamma    y = x^(1 / gamma)
///     bt709    y = 4.5 x below 0.018, else 1.099 x^0.45 - 0.099       (ITU-R BT.709, the transfer of HD video)
///     table    straight lines between points that rise from (0, 0) to (1, 1)
///
/// x is the code above black over that of white, y likewise, both from 0 to 1.
struct ToneCurve {
  enum class Kind { linear, gamma, bt709, table };
  Kind kind = Kind::linear;
  double gamma = 2.2;             ///< of Kind::gamma
  std::vector<double> from = {};  ///< of Kind::table: x, rising from 0 to 1,
  std::vector<double> to = {};    ///< and y

  /// y of x; x is limited to 0 … 1.
  double operator()(double x) const;
  /// x of y; y is limited to 0 … 1.
  double inverse(double y) const;
};

const char* name_of(ToneCurve::Kind kind);

/// The scatter of the pixels of a sensor type; if all are zero, the pixels are alike.
struct PixelSpread {
  double dark_signal_e_s = 0.0;  ///< mean
  double prnu = 0.0;             ///< standard deviation of the response, relative
  double dsnu_e = 0.0;           ///< standard deviation of the offset
  double hot_fraction = 0.0;
  double hot_signal_e_s = 0.0;  ///< mean excess of a hot pixel over the dark signal
  double dead_fraction = 0.0;   ///< no response to light

  bool operator==(const PixelSpread&) const = default;
};

/// How the pixels of one sensor differ from one another, row by row, for each pixel: the same in all frames and views
/// of a camera.
///
///     response_p = max(0, 1 + PRNU z1)            0 for a dead pixel
///     dark_p     = dark signal * exposure         plus an exponentially distributed signal for a hot pixel
///     offset_p   = DSNU z2
///
/// with z1, z2 standard normal, white over the sensor (EMVA standard 1288: photo response and dark signal
/// non-uniformity; DSNU at the exposure of the clip). A function of only the seed and the pixel's position
/// (RandomPurpose::fixed_pattern).
struct FixedPattern {
  int width = 0;
  int height = 0;
  std::vector<float> response;
  std::vector<float> dark_e;
  std::vector<float> offset_e;
};

FixedPattern make_fixed_pattern(const PixelSpread& spread, double exposure_s, std::uint64_t seed, int width,
                                int height);

enum class Colour { mono, bayer };

struct Sensor {
  int bit_depth = 8;  ///< of the output codes, 8 to 16
  double full_well_e = 60000.0;
  double read_noise_e = 30.0;
  double gain_dn_per_e = 253.0 / 60000.0;  ///< codes of the converter
  double offset_dn = 2.0;                  ///< likewise
  std::optional<int> converter_bits = {};  ///< bit_depth, if not given; never less
  PixelSpread pixels = {};
  ToneCurve tone = {};  ///< from the converter's codes to the output codes
  Colour colour = Colour::mono;
  std::array<double, 3> colour_response = {0.55, 1.0, 0.65};  ///< red, green, blue to white light, relative to the
                                                              ///< strongest

  int largest_code() const { return (1 << bit_depth) - 1; }
  int largest_converter_code() const { return (1 << converter_bits.value_or(bit_depth)) - 1; }
};

/// Key of the noise: the same key and pixel give the same number.
struct NoiseKey {
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;  ///< a clip or a view
  std::uint32_t frame = 0;
};

/// Mean number of electrons from which the Poisson distribution is taken as normal (its skewness is 1/16 there).
inline constexpr float kNormalMean = 256.0f;

/// The converter's codes of the pixels of `rect`, row by row, from the expected electrons of the whole image, without
/// colours. `codes` holds rect.width x rect.height; the 8-bit form is for 8-bit converters. Without a pattern all
/// pixels are alike. std::logic_error if sizes do not match.
void read_out(const Sensor& sensor, const FloatImage& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint8_t> codes, Simd simd = Simd::best, const FixedPattern* pattern = nullptr);
void read_out(const Sensor& sensor, const FloatImage& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint16_t> codes, Simd simd = Simd::best, const FixedPattern* pattern = nullptr);

}  // namespace glidelab::render
