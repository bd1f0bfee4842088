#include "render/paint/tile_row.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace glidelab::render {

namespace {

constexpr std::size_t kMostLines = 4;

/// A polygon's lines in the coordinates of each pixel, one after another.
struct RowLines {
  std::array<TileRow, kMostLines> s, gx, gy, reach;
  TileRow through;   ///< how many lines cut the pixel
  TileRow coverage;  ///< correct if at most one line cuts the pixel, or if the pixel is outside of one
  bool cut_twice;    ///< whether any pixel is cut by two or more lines and outside of none
};

/// The fraction of the pixel on the inner side of one line (tile_row.h), without branches.
[[gnu::always_inline]] inline double inside_part(double s, double gx, double gy) {
  const double ax = std::abs(gx), ay = std::abs(gy), t = std::abs(s);
  const double a = ax > ay ? ax : ay, b = ax > ay ? ay : ax;
  const double over = 0.5 * (a + b) - t, corner = over > 0.0 ? over : 0.0;
  const double both = 2.0 * a * b, area = both > 1e-300 ? both : 1e-300;
  const bool across = t <= 0.5 * (a - b);
  const double part = (across ? t : corner * corner) / (across ? a : area);
  const double beyond = across ? 0.5 - part : part;
  return s > 0.0 ? 1.0 - beyond : beyond;
}

/// Tests the square of a pixel against each line.
[[gnu::always_inline]] inline void lines_in_pixels(std::span<const Eigen::Vector3d> lines, const RowRays& rays,
                                                   RowLines& out) {
  TileRow through, outside, coverage;
  for (int i = 0; i < kRayTile; ++i) {
    through[i] = outside[i] = 0.0;
    coverage[i] = 1.0;
  }
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double la = lines[k].x(), lb = lines[k].y(), lc = lines[k].z();
    for (int i = 0; i < kRayTile; ++i) {
      const double gx = la * rays.dxdu[i] + lb * rays.dydu[i], gy = la * rays.dxdv[i] + lb * rays.dydv[i];
      const double s = la * rays.x[i] + lb * rays.y[i] + lc;
      const double reach = 0.5 * (std::abs(gx) + std::abs(gy)), part = inside_part(s, gx, gy);
      out.s[k][i] = s;
      out.gx[k][i] = gx;
      out.gy[k][i] = gy;
      out.reach[k][i] = reach;
      coverage[i] = s < reach ? part : coverage[i];
      through[i] += s < reach ? 1.0 : 0.0;
      outside[i] = s <= -reach ? 1.0 : outside[i];
    }
  }
  double most = 0.0;
  for (int i = 0; i < kRayTile; ++i) {
    const double count = outside[i] > 0.0 ? 0.0 : through[i];
    most = most > count ? most : count;
    out.through[i] = count;
    out.coverage[i] = outside[i] > 0.0 ? 0.0 : coverage[i];
  }
  out.cut_twice = most > 1.0;
}

/// A sphere as seen in one view.
struct Ball {
  double x, y, z;  // c
  double center_x, center_y;
  double distance;  // |c|
  double radius;
};

/// The position of a pixel relative to a ball's outline, from distances of rays: well within, well outside, or near.
///
/// The distance of the ray (x, y, 1) from the centre is |(e, 0) x c| / |(x, y, 1)|, e = (x, y) - (x_c, y_c). Its
/// gradient is at most |c| and half of the distance, so that within half a pixel it changes by no more than that times
/// the change of the ray; an extra tenth allows for the outline's curvature.
[[gnu::always_inline]] inline void near_outline(const Ball& ball, const RowRays& rays, TileRow& coverage,
                                                std::array<double, kRayTile>& cut) {
  const double z2 = ball.z * ball.z;
  for (int i = 0; i < kRayTile; ++i) {
    const double x = rays.x[i], y = rays.y[i], off_x = x - ball.center_x, off_y = y - ball.center_y;
    const double turned = off_x * ball.y - off_y * ball.x;
    const double ray2 = 1.0 + (x * x + y * y);
    const double square = z2 * (off_x * off_x + off_y * off_y) + turned * turned;  // of the distance, times ray2
    const double step =
        (std::abs(rays.dxdu[i]) + std::abs(rays.dydu[i])) + (std::abs(rays.dxdv[i]) + std::abs(rays.dydv[i]));
    const double reach = 0.55 * (ball.distance + ball.radius) * step;
    const double far = ball.radius + reach, near = ball.radius - reach;
    const double outside = square > far * far * ray2 ? 1.0 : 0.0;
    const double inside = near > 0.0 ? near : 0.0;
    const double within = square < inside * inside * ray2 ? 1.0 : 0.0;
    coverage[i] = within;
    cut[i] = 1.0 - outside - within;
  }
}

constexpr int kQuarters = 4 * kRayTile;

/// Quarters of pixels: the rays of their middles, the slopes of these, and the covered fraction of each.
struct Quarters {
  std::array<double, kQuarters> x, y, dxdu, dxdv, dydu, dydv, coverage;
};

[[gnu::always_inline]] inline void cover_quarters(const Ball& ball, int count, Quarters& q) {
  const double z2 = ball.z * ball.z, least = 1e-3 * ball.radius, bend = 1.0 / (24.0 * ball.radius);
  for (int i = 0; i < count; ++i) {
    // Dividing by the distance's gradient in the image converts it to pixels.
    const double x = q.x[i], y = q.y[i], ex = x - ball.center_x, ey = y - ball.center_y;
    const double ray2 = 1.0 + (x * x + y * y);
    const double turn = ex * ball.y - ey * ball.x;
    const double distance2 = (z2 * (ex * ex + ey * ey) + turn * turn) / ray2;
    const double root = std::sqrt(distance2), distance = root > least ? root : least;
    const double per_scale = 1.0 / (ray2 * distance);
    const double rise_x = (z2 * ex + turn * ball.y - distance2 * x) * per_scale;
    const double rise_y = (z2 * ey - turn * ball.x - distance2 * y) * per_scale;
    const double gu = 0.5 * (rise_x * q.dxdu[i] + rise_y * q.dydu[i]);
    const double gv = 0.5 * (rise_x * q.dxdv[i] + rise_y * q.dydv[i]);
    // The arc lies inside its tangent: on average over a square's side by 1/(24 R) of it.
    const double bulge = (gu * gu + gv * gv) * bend;
    q.coverage[i] = inside_part(ball.radius - distance - bulge, gu, gv);
  }
}

[[gnu::always_inline]] inline void cover_by_ball(const Ball& ball, const RowRays& rays, TileRow& coverage) {
  TileRow cut;
  near_outline(ball, rays, coverage, cut);
  std::array<int, kRayTile> pixel;
  int pixels = 0;
  for (int i = 0; i < kRayTile; ++i) {
    if (cut[i] > 0.0) pixel[pixels++] = i;
  }
  if (pixels == 0) return;
  Quarters quarters;
  for (int k = 0; k < pixels; ++k) {
    const int i = pixel[k];
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double u = (quarter & 1) == 0 ? -0.25 : 0.25, v = (quarter & 2) == 0 ? -0.25 : 0.25;
      const int at = 4 * k + quarter;
      quarters.x[at] = rays.x[i] + u * rays.dxdu[i] + v * rays.dxdv[i];
      quarters.y[at] = rays.y[i] + u * rays.dydu[i] + v * rays.dydv[i];
      quarters.dxdu[at] = rays.dxdu[i];
      quarters.dxdv[at] = rays.dxdv[i];
      quarters.dydu[at] = rays.dydu[i];
      quarters.dydv[at] = rays.dydv[i];
    }
  }
  cover_quarters(ball, 4 * pixels, quarters);
  for (int k = 0; k < pixels; ++k) {
    const double* const of = quarters.coverage.data() + 4 * k;
    coverage[pixel[k]] = 0.25 * of[0] + 0.25 * of[1] + 0.25 * of[2] + 0.25 * of[3];
  }
}

void lines_in_pixels_baseline(std::span<const Eigen::Vector3d> lines, const RowRays& rays, RowLines& out) {
  lines_in_pixels(lines, rays, out);
}
void cover_by_ball_baseline(const Ball& ball, const RowRays& rays, TileRow& coverage) {
  cover_by_ball(ball, rays, coverage);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations on more lanes.
[[gnu::target("avx2")]] void lines_in_pixels_avx2(std::span<const Eigen::Vector3d> lines, const RowRays& rays,
                                                  RowLines& out) {
  lines_in_pixels(lines, rays, out);
}
[[gnu::target("avx2")]] void cover_by_ball_avx2(const Ball& ball, const RowRays& rays, TileRow& coverage) {
  cover_by_ball(ball, rays, coverage);
}
#endif

}  // namespace

RowRays rays_of_row(const RayTable& rays, int x, int y, int count) {
  RowRays row;
  const std::size_t at = static_cast<std::size_t>(y) * rays.width + x;
  for (int i = 0; i < kRayTile; ++i) {
    const std::size_t pixel = at + static_cast<std::size_t>(std::min(i, count - 1));
    const float* const ray = rays.x_y_dxdu_dxdv.data() + 4 * pixel;
    const float* const slope = rays.dydu_dydv.data() + 2 * pixel;
    row.x[i] = static_cast<double>(ray[0]);
    row.y[i] = static_cast<double>(ray[1]);
    row.dxdu[i] = static_cast<double>(ray[2]);
    row.dxdv[i] = static_cast<double>(ray[3]);
    row.dydu[i] = static_cast<double>(slope[0]);
    row.dydv[i] = static_cast<double>(slope[1]);
  }
  return row;
}

TileRow polygon_row(std::span<const Eigen::Vector3d> lines, const RowRays& rays, [[maybe_unused]] Simd simd) {
  if (lines.size() > kMostLines) throw std::logic_error("too many lines around a polygon");
  RowLines at;
#if defined(__x86_64__)
  base::uses_avx2(simd) ? lines_in_pixels_avx2(lines, rays, at) : lines_in_pixels_baseline(lines, rays, at);
#else
  lines_in_pixels_baseline(lines, rays, at);
#endif
  if (!at.cut_twice) return at.coverage;
  std::array<PixelLine, kMostLines> through;  // one for all pixels: clearing it is a quarter of the work
  for (int i = 0; i < kRayTile; ++i) {
    if (!(at.through[i] > 1.0)) continue;
    std::size_t count = 0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (at.s[k][i] < at.reach[k][i]) through[count++] = {at.s[k][i], at.gx[k][i], at.gy[k][i]};
    }
    at.coverage[i] = convex_coverage(std::span(through).first(count));
  }
  return at.coverage;
}

TileRow sphere_row(const Eigen::Vector3d& center_C, double radius_m, const RowRays& rays, [[maybe_unused]] Simd simd) {
  const Ball ball{center_C.x(),    center_C.y(), center_C.z(), center_C.x() / center_C.z(), center_C.y() / center_C.z(),
                  center_C.norm(), radius_m};
  TileRow coverage;
#if defined(__x86_64__)
  if (base::uses_avx2(simd)) {
    cover_by_ball_avx2(ball, rays, coverage);
    return coverage;
  }
#endif
  cover_by_ball_baseline(ball, rays, coverage);
  return coverage;
}

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
