/// How the pixels of one sensor differ from one another: the same in all frames and views of a camera.
///
///     response_p = max(0, 1 + PRNU z1)            0 for a dead pixel
///     dark_p     = dark signal * exposure         more by an exponentially distributed signal for a hot pixel
///     offset_p   = DSNU z2
///
/// with z1, z2 standard normal, white over the sensor (EMVA standard 1288: photo response and dark signal
/// non-uniformity; DSNU at the exposure of the clip). A function of the seed and the
/// pixel's place alone (RandomPurpose::fixed_pattern).
#pragma once

#include <cstdint>
#include <vector>

namespace glidelab::render {

/// What the pixels of a make of sensors scatter by; all zero, they are alike.
struct PixelSpread {
  double dark_signal_e_s = 0.0;  ///< mean
  double prnu = 0.0;             ///< standard deviation of the response, relative
  double dsnu_e = 0.0;           ///< standard deviation of the offset
  double hot_fraction = 0.0;
  double hot_signal_e_s = 0.0;  ///< mean of what a hot pixel has beyond the dark signal
  double dead_fraction = 0.0;   ///< no response to light

  bool operator==(const PixelSpread&) const = default;
};

/// Row by row, for each pixel.
struct FixedPattern {
  int width = 0;
  int height = 0;
  std::vector<float> response;
  std::vector<float> dark_e;
  std::vector<float> offset_e;
};

FixedPattern make_fixed_pattern(const PixelSpread& spread, double exposure_s, std::uint64_t seed, int width,
                                int height);

}  // namespace glidelab::render
