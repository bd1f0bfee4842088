/// How much of a pixel lies within straight outlines; exact.
///
/// A line is given in the pixel's own coordinates, |x|, |y| <= 1/2: its inner side is where s + gx x + gy y > 0.
#pragma once

#include <span>

namespace glidelab::render {

struct PixelLine {
  double s = 0.0;
  double gx = 0.0;
  double gy = 0.0;
};

/// The fraction of the pixel on the inner side of all lines (up to eight): the pixel's square is clipped by one line
/// after another (Sutherland and Hodgman), and the remaining area is computed.
double convex_coverage(std::span<const PixelLine> lines);

}  // namespace glidelab::render
