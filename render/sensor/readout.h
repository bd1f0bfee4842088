/// From expected electrons to the codes of a camera's images: the sensor with its fixed pattern (sensor.h), then, if
/// present, the Bayer mosaic and the tone curve.
///
///     converter codes ─► demosaiced to grey, rounded ─► round(tone((code - offset) / (largest - offset)) largest out)
///
/// With a tone curve black is code 0; without one, and without more converter bits, the output is the converter's
/// codes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/image/float_image.h"
#include "render/sensor/sensor.h"

namespace glidelab::render {

/// Position of a pixel in the 2 x 2 mosaic.
inline std::size_t mosaic_place(int x, int y) {
  return static_cast<std::size_t>(2 * (y & 1) + (x & 1));
}

/// Responses of the pixels to white light, by position.
std::array<float, 4> mosaic_response(const std::array<double, 3>& red_green_blue);

/// A colour sensor that sees a scene without colours: Bayer mosaic and bilinear demosaicing to grey.
///
/// Rows of red, green, red, … and green, blue, green, … (RGGB, the first pixel red). White balance divides each pixel
/// by its colour's response to white light; the two colours that a pixel lacks are the means of the nearest pixels that
/// have them (2 or 4); grey is 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601, as in video decoders). All of this is linear,
/// so it amounts to one of four masks of 3 x 3 weights, by the pixel's position in the mosaic.
///
/// Grey of the pixels of `inner` (in coordinates of the whole image of width x height), row by row, from the codes of
/// `outer`, which contains all of `inner` and its neighbours: one more pixel on each side that is not the image's edge.
/// At an edge the image is mirrored about its last pixel, which keeps the colours in place. Codes are relative to
/// `offset_dn`, and so is the result.
FloatImage demosaic(std::span<const std::uint16_t> codes, const PixelRect& outer, const PixelRect& inner, int width,
                    int height, const std::array<float, 4>& response, float offset_dn);

/// `inner` with the neighbours that demosaic() needs.
PixelRect with_neighbours(const PixelRect& inner, int width, int height);

/// Made once for a camera; const and safe to share among threads.
class Readout {
 public:
  /// The seed and the images' size make the fixed pattern; the exposure scales the dark signal.
  Readout(const Sensor& sensor, double exposure_s, std::uint64_t seed, int width, int height);

  const Sensor& sensor() const { return sensor_; }

  /// The pixels whose expected electrons affect the codes of `rect`: including a mosaic's neighbours.
  PixelRect seen_by(const PixelRect& rect) const;

  /// Codes of the pixels of `rect`, row by row; 8-bit ones for bit_depth 8. The same in any part of the image.
  void read(const FloatImage& expected_e, std::uint32_t stream, std::uint32_t frame, const PixelRect& rect,
            std::span<std::uint8_t> codes) const;
  void read(const FloatImage& expected_e, std::uint32_t stream, std::uint32_t frame, const PixelRect& rect,
            std::span<std::uint16_t> codes) const;

 private:
  template <typename Code>
  void read_as(const FloatImage& expected_e, const NoiseKey& key, const PixelRect& rect, std::span<Code> codes) const;

  Sensor sensor_;
  std::uint64_t seed_;
  int width_;
  int height_;
  std::array<float, 4> response_;
  FixedPattern pattern_;
  bool patterned_ = false;
  std::vector<std::uint16_t> table_;  ///< output code for each converter code; empty if they are the same
};

/// The converter's code, as a real number, that yields the output `code`; with a tone curve `code` is limited to its
/// range.
double converter_code(const Sensor& sensor, double code);

}  // namespace glidelab::render
