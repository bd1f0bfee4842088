/// How much of a pixel lies within straight outlines; exact.
///
/// A line is given in the pixel's own coordinates, |x|, |y| <= 1/2: its inner side is where s + gx x + gy y > 0.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace glidelab::render {

struct PixelLine {
  double s = 0.0;
  double gx = 0.0;
  double gy = 0.0;
};

/// The part of the pixel on the inner side of one line.
inline double half_plane_coverage(const PixelLine& line) {
  const double a = std::max(std::abs(line.gx), std::abs(line.gy));
  const double b = std::min(std::abs(line.gx), std::abs(line.gy));
  const double t = std::abs(line.s);
  const double corner = std::max(0.5 * (a + b) - t, 0.0);  // where the line cuts a corner off: a triangle
  const double beyond = t <= 0.5 * (a - b) ? 0.5 - t / a : corner * corner / std::max(2.0 * a * b, 1e-300);
  return line.s > 0.0 ? 1.0 - beyond : beyond;
}

/// The part of the pixel on the inner side of all lines (up to eight): the pixel's square cut by one line after the
/// other (Sutherland and Hodgman), and the area of what is left.
double convex_coverage(std::span<const PixelLine> lines);

}  // namespace glidelab::render
