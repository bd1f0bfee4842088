#include "render/sensor/mosaic.h"

namespace glidelab::render {
namespace {

constexpr float kRed = 0.299f;
constexpr float kGreen = 0.587f;
constexpr float kBlue = 0.114f;

/// Weights of a pixel's 3 x 3 neighbourhood: itself, left and right (each), above and below, the corners.
struct Mask {
  float center, side, upright, corner;
};

/// By place in the mosaic: red, green in a row of red, green in a row of blue, blue.
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

FloatPicture demosaic(std::span<const std::uint16_t> codes, const PixelRect& outer, const PixelRect& inner, int width,
                      int height, const std::array<float, 4>& response, float offset_dn) {
  FloatPicture balanced(outer.width, outer.height);
  for (int y = 0; y < outer.height; ++y) {
    for (int x = 0; x < outer.width; ++x) {
      const float code = codes[static_cast<std::size_t>(y) * outer.width + x];
      balanced.at(x, y) = (code - offset_dn) / response[mosaic_place(outer.x + x, outer.y + y)];
    }
  }
  FloatPicture grey(inner.width, inner.height);
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

}  // namespace glidelab::render
