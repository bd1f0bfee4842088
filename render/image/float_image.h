/// An image of floats in memory, and a rectangle of pixels.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace glidelab::render {

/// Columns [x, x + width), rows [y, y + height); empty if a side is not positive.
struct PixelRect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const PixelRect&) const = default;
};

inline PixelRect intersection(const PixelRect& a, const PixelRect& b) {
  const int left = std::max(a.x, b.x);
  const int top = std::max(a.y, b.y);
  const int right = std::min(a.x + a.width, b.x + b.width);
  const int bottom = std::min(a.y + a.height, b.y + b.height);
  return {left, top, std::max(0, right - left), std::max(0, bottom - top)};
}

/// The smallest rectangle that contains both; an empty one contains nothing.
inline PixelRect united(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int left = std::min(a.x, b.x);
  const int top = std::min(a.y, b.y);
  return {left, top, std::max(a.x + a.width, b.x + b.width) - left, std::max(a.y + a.height, b.y + b.height) - top};
}

/// Row by row from the top, no padding. Radiance (1 is a white wall in the scene's light) or electrons, as stated where
/// it is used.
struct FloatImage {
  int width = 0;
  int height = 0;
  std::vector<float> values;

  FloatImage() = default;
  FloatImage(int width_px, int height_px)
      : width(width_px), height(height_px), values(static_cast<std::size_t>(width_px) * height_px, 0.0f) {}

  float& at(int x, int y) { return values[static_cast<std::size_t>(y) * width + x]; }
  float at(int x, int y) const { return values[static_cast<std::size_t>(y) * width + x]; }
  std::span<float> row(int y, int x, int count) {
    return {values.data() + static_cast<std::size_t>(y) * width + x, static_cast<std::size_t>(count)};
  }
  std::span<const float> row(int y, int x, int count) const {
    return {values.data() + static_cast<std::size_t>(y) * width + x, static_cast<std::size_t>(count)};
  }
};

}  // namespace glidelab::render
