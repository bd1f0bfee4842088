#include "render/sensor/readout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace glidelab::render {
namespace {

constexpr float kRed = 0.299f;
constexpr float kGreen = 0.587f;
constexpr float kBlue = 0.114f;

/// Weights of a pixel's 3 x 3 neighbourhood: itself, left and right (each), above and below, the corners.
struct Mask {
  float center, side, upright, corner;
};

/// By position in the mosaic: red, green in a row of red, green in a row of blue, blue.
constexpr std::array<Mask, 4> kMasks = {{{kRed, kGreen / 4.0f, kGreen / 4.0f, kBlue / 4.0f},
                                         {kGreen, kRed / 2.0f, kBlue / 2.0f, 0.0f},
                                         {kGreen, kBlue / 2.0f, kRed / 2.0f, 0.0f},
                                         {kBlue, kGreen / 4.0f, kGreen / 4.0f, kRed / 4.0f}}};

int mirrored(int i, int count) {
  return i < 0 ? -i : i >= count ? 2 * (count - 1) - i : i;
}

}  // namespace

std::array<float, 4> mosaic_response(const std::array<double, 3>& red_green_blue) {
  const auto green = static_cast<float>(red_green_blue[1]);
  return {static_cast<float>(red_green_blue[0]), green, green, static_cast<float>(red_green_blue[2])};
}

PixelRect with_neighbours(const PixelRect& inner, int width, int height) {
  return intersection({inner.x - 1, inner.y - 1, inner.width + 2, inner.height + 2}, {0, 0, width, height});
}

FloatImage demosaic(std::span<const std::uint16_t> codes, const PixelRect& outer, const PixelRect& inner, int width,
                    int height, const std::array<float, 4>& response, float offset_dn) {
  FloatImage balanced(outer.width, outer.height);
  for (int y = 0; y < outer.height; ++y) {
    for (int x = 0; x < outer.width; ++x) {
      const float code = codes[static_cast<std::size_t>(y) * outer.width + x];
      balanced.at(x, y) = (code - offset_dn) / response[mosaic_place(outer.x + x, outer.y + y)];
    }
  }
  FloatImage grey(inner.width, inner.height);
  for (int y = inner.y; y < inner.y + inner.height; ++y) {
    const float* here = balanced.values.data() + static_cast<std::ptrdiff_t>(y - outer.y) * outer.width;
    const float* above =
        balanced.values.data() + static_cast<std::ptrdiff_t>(mirrored(y - 1, height) - outer.y) * outer.width;
    const float* below =
        balanced.values.data() + static_cast<std::ptrdiff_t>(mirrored(y + 1, height) - outer.y) * outer.width;
    for (int x = inner.x; x < inner.x + inner.width; ++x) {
      const Mask& mask = kMasks[mosaic_place(x, y)];
      const int at = x - outer.x;
      const int left = mirrored(x - 1, width) - outer.x;
      const int right = mirrored(x + 1, width) - outer.x;
      grey.at(x - inner.x, y - inner.y) = mask.center * here[at] + mask.side * (here[left] + here[right]) +
                                          mask.upright * (above[at] + below[at]) +
                                          mask.corner * (above[left] + above[right] + below[left] + below[right]);
    }
  }
  return grey;
}

namespace {

bool converts(const Sensor& sensor) {
  return sensor.tone.kind != ToneCurve::Kind::linear || sensor.largest_converter_code() != sensor.largest_code();
}

/// Without a tone curve the black level is kept, so that offset and gain of the output are those of the converter,
/// scaled.
double black_of(const Sensor& sensor) {
  return sensor.tone.kind == ToneCurve::Kind::linear ? 0.0 : sensor.offset_dn;
}

std::vector<std::uint16_t> code_table(const Sensor& sensor) {
  if (!converts(sensor)) return {};
  const double black = black_of(sensor);
  std::vector<std::uint16_t> table;
  for (int code = 0; code <= sensor.largest_converter_code(); ++code) {
    const double x = (code - black) / (sensor.largest_converter_code() - black);
    table.push_back(static_cast<std::uint16_t>(std::lround(sensor.tone(x) * sensor.largest_code())));
  }
  return table;
}

}  // namespace

Readout::Readout(const Sensor& sensor, double exposure_s, std::uint64_t seed, int width, int height)
    : sensor_(sensor),
      seed_(seed),
      width_(width),
      height_(height),
      response_(mosaic_response(sensor.colour_response)),
      patterned_(sensor.pixels != PixelSpread{} || sensor.colour == Colour::bayer),
      table_(code_table(sensor)) {
  if (!patterned_) return;
  pattern_ = make_fixed_pattern(sensor.pixels, exposure_s, seed, width, height);
  if (sensor.colour == Colour::mono) return;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      pattern_.response[static_cast<std::size_t>(y) * width + x] *= response_[mosaic_place(x, y)];
    }
  }
}

PixelRect Readout::seen_by(const PixelRect& rect) const {
  return sensor_.colour == Colour::mono ? rect : with_neighbours(rect, width_, height_);
}

void Readout::read(const FloatImage& expected_e, std::uint32_t stream, std::uint32_t frame, const PixelRect& rect,
                   std::span<std::uint8_t> codes) const {
  read_as(expected_e, {seed_, stream, frame}, rect, codes);
}
void Readout::read(const FloatImage& expected_e, std::uint32_t stream, std::uint32_t frame, const PixelRect& rect,
                   std::span<std::uint16_t> codes) const {
  read_as(expected_e, {seed_, stream, frame}, rect, codes);
}

template <typename Code>
void Readout::read_as(const FloatImage& expected_e, const NoiseKey& key, const PixelRect& rect,
                      std::span<Code> codes) const {
  const FixedPattern* pattern = patterned_ ? &pattern_ : nullptr;
  if (table_.empty() && sensor_.colour == Colour::mono) {
    read_out(sensor_, expected_e, key, rect, codes, Simd::best, pattern);
    return;
  }
  if (sensor_.largest_code() > std::numeric_limits<Code>::max()) {
    throw std::logic_error(fmt::format("codes of {} bits asked for in fewer", sensor_.bit_depth));
  }
  const auto out = [&](std::size_t converter) {
    return static_cast<Code>(table_.empty() ? converter : table_[converter]);
  };
  if (sensor_.colour == Colour::mono) {
    std::vector<std::uint16_t> raw(codes.size());
    read_out(sensor_, expected_e, key, rect, std::span<std::uint16_t>(raw), Simd::best, pattern);
    std::transform(raw.begin(), raw.end(), codes.begin(), out);
    return;
  }
  const PixelRect outer = seen_by(rect);
  std::vector<std::uint16_t> raw(static_cast<std::size_t>(outer.width) * outer.height);
  read_out(sensor_, expected_e, key, outer, std::span<std::uint16_t>(raw), Simd::best, pattern);
  const auto offset = static_cast<float>(sensor_.offset_dn);
  const FloatImage grey = demosaic(raw, outer, rect, expected_e.width, expected_e.height, response_, offset);
  const auto largest = static_cast<float>(sensor_.largest_converter_code());
  std::transform(grey.values.begin(), grey.values.end(), codes.begin(), [&](float value) {
    return out(static_cast<std::size_t>(std::clamp(value + offset + 0.5f, 0.0f, largest)));
  });
}

double converter_code(const Sensor& sensor, double code) {
  if (!converts(sensor)) return code;
  const double part = code / sensor.largest_code();
  if (sensor.tone.kind == ToneCurve::Kind::linear) return part * sensor.largest_converter_code();
  return sensor.offset_dn + sensor.tone.inverse(part) * (sensor.largest_converter_code() - sensor.offset_dn);
}

}  // namespace glidelab::render
