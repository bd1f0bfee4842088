#include "render/paint/pixel_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace glidelab::render {
namespace {

struct Point {
  double x, y;
};
// A square has 4 corners, and each line adds at most one.
using CutCorners = std::array<Point, 12>;

}  // namespace

double convex_coverage(std::span<const PixelLine> lines) {
  if (lines.size() > 8) throw std::logic_error("too many lines through a pixel");
  CutCorners corners{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
  std::size_t count = 4;
  for (const PixelLine& line : lines) {
    CutCorners kept{};
    std::size_t kept_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Point& p = corners[i];
      const Point& q = corners[(i + 1) % count];
      const double at_p = line.s + line.gx * p.x + line.gy * p.y;
      const double at_q = line.s + line.gx * q.x + line.gy * q.y;
      if (at_p >= 0.0) kept[kept_count++] = p;
      if ((at_p >= 0.0) != (at_q >= 0.0)) {
        const double share = at_p / (at_p - at_q);
        kept[kept_count++] = {p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)};
      }
    }
    corners = kept;
    count = kept_count;
    if (count < 3) return 0.0;
  }
  double twice_area = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Point& p = corners[i];
    const Point& q = corners[(i + 1) % count];
    twice_area += p.x * q.y - q.x * p.y;
  }
  return std::clamp(0.5 * twice_area, 0.0, 1.0);
}

}  // namespace glidelab::render
