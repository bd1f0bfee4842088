/// How much of a pixel lies on one side of a line.
#pragma once

#include <algorithm>
#include <cmath>

namespace glidelab::render {

/// The part of the unit square |x|, |y| <= 1/2 in which s + gx x + gy y > 0; exact.
inline double half_plane_coverage(double s, double gx, double gy) {
  const double a = std::max(std::abs(gx), std::abs(gy));
  const double b = std::min(std::abs(gx), std::abs(gy));
  const double t = std::abs(s);
  const double corner = std::max(0.5 * (a + b) - t, 0.0);  // where the line cuts a corner off: a triangle
  const double beyond = t <= 0.5 * (a - b) ? 0.5 - t / a : corner * corner / std::max(2.0 * a * b, 1e-300);
  return s > 0.0 ? 1.0 - beyond : beyond;
}

}  // namespace glidelab::render
