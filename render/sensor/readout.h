/// From expected electrons to the codes of a camera's images: the sensor with its fixed pattern (sensor.h),
/// then, where it has them, the mosaic (mosaic.h) and the tone curve (tone_curve.h).
///
///     converter codes ─► demosaiced to grey, rounded ─► round(tone((code - offset) / (largest - offset)) largest out)
///
/// With a tone curve black is code 0; without one and without more converter bits the converter's codes come out.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/sensor/sensor.h"

namespace glidelab::render {

/// Made once for a camera; const and safe to share among threads.
class Readout {
 public:
  /// The seed and the images' size make the fixed pattern; the exposure scales the dark signal.
  Readout(const Sensor& sensor, double exposure_s, std::uint64_t seed, int width, int height);

  const Sensor& sensor() const { return sensor_; }

  /// The pixels of which the expected electrons count for the codes of `rect`: a mosaic's neighbours too.
  PixelRect seen_by(const PixelRect& rect) const;

  /// Codes of the pixels of `rect`, row by row; 8-bit ones for bit_depth 8. The same in any part of the image.
  void read(const FloatPicture& expected_e, std::uint32_t stream, std::uint32_t frame, const PixelRect& rect,
            std::span<std::uint8_t> codes) const;
  void read(const FloatPicture& expected_e, std::uint32_t stream, std::uint32_t frame, const PixelRect& rect,
            std::span<std::uint16_t> codes) const;

 private:
  template <typename Code>
  void read_as(const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect, std::span<Code> codes) const;

  Sensor sensor_;
  std::uint64_t seed_;
  int width_;
  int height_;
  std::array<float, 4> response_;
  FixedPattern pattern_;
  bool patterned_ = false;
  std::vector<std::uint16_t> table_;  ///< code that comes out, by the converter's; empty where they are the same
};

/// The converter's code, as a real number, that comes out as `code`; with a tone curve `code` is limited to what there
/// is.
double converter_code(const Sensor& sensor, double code);

}  // namespace glidelab::render
