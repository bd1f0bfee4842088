#include <algorithm>
#include <cmath>
#include <vector>

#include "render/paint/tile_row.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

constexpr double kFocal = 900.0;  // px

/// A row of a camera whose lens turns and stretches the image a little here.
RowRays row_at(double x, double y) {
  RowRays rays;
  for (int i = 0; i < kRayTile; ++i) {
    rays.dxdu[i] = 1.02 / kFocal;
    rays.dxdv[i] = 0.01 / kFocal;
    rays.dydu[i] = -0.02 / kFocal;
    rays.dydv[i] = 0.99 / kFocal;
    rays.x[i] = x + i * rays.dxdu[i];
    rays.y[i] = y + i * rays.dydu[i];
  }
  return rays;
}

/// The part of a pixel's rays that meet a ball, of 400 x 400.
double by_rays(const Eigen::Vector3d& c, double radius, const RowRays& rays, int i) {
  constexpr int kRays = 400;
  int met = 0;
  for (int k = 0; k < kRays * kRays; ++k) {
    const double u = (k % kRays + 0.5) / kRays - 0.5, v = (k / kRays + 0.5) / kRays - 0.5;
    const Eigen::Vector3d ray(rays.x[i] + u * rays.dxdu[i] + v * rays.dxdv[i],
                              rays.y[i] + u * rays.dydu[i] + v * rays.dydv[i], 1.0);
    met += ray.cross(c).norm() < radius * ray.norm() ? 1 : 0;
  }
  return static_cast<double>(met) / (kRays * kRays);
}

}  // namespace

TEST_CASE("a ball's coverage of a row of pixels is the part of their rays that meet it") {
  const Eigen::Vector3d c(0.2, -0.12, 1.5);
  for (const double radius_px : {3.0, 8.0}) {
    const double radius = radius_px / kFocal * c.z();
    for (int row = -10; row <= 10; ++row) {
      const RowRays rays = row_at(c.x() / c.z() - 0.003, c.y() / c.z() + (row + 0.3) / kFocal);
      const TileRow coverage = sphere_row(c, radius, rays);
      for (int i = 0; i < kRayTile; ++i) {
        // Rays in rows along a straight outline: half a row, 1/800; the outline's curvature, beyond first order in each
        // quarter of a pixel, is (1/4)^4 / (8 R^3).
        INFO("row " << row << " pixel " << i << " radius " << radius_px);
        CHECK(std::abs(coverage[i] - by_rays(c, radius, rays, i)) < 2.5e-3);
      }
    }
  }
}

TEST_CASE("wide vectors cover a row to the last bit as narrow ones do") {
  const Eigen::Vector3d c(0.2, -0.12, 1.5);
  const std::vector<Eigen::Vector3d> lines{{0.8, 0.6, -0.8 * c.x() / c.z() - 0.6 * c.y() / c.z()},
                                           {-0.5, 1.0, 0.5 * c.x() / c.z() - c.y() / c.z()}};
  for (int row = -10; row <= 10; ++row) {
    const RowRays rays = row_at(c.x() / c.z() - 0.003, c.y() / c.z() + (row + 0.3) / kFocal);
    CHECK(sphere_row(c, 0.012, rays, Simd::best) == sphere_row(c, 0.012, rays, Simd::baseline));
    CHECK(polygon_row(lines, rays, Simd::best) == polygon_row(lines, rays, Simd::baseline));
  }
}

TEST_CASE("a polygon covers a row of pixels as its lines cut each of them") {
  // Directions of lines through points near the row, in all quadrants and along the rows and columns.
  std::size_t once = 0, twice = 0, outside = 0, whole = 0;
  const RowRays rays = row_at(0.1, -0.05);
  for (int first = 0; first < 24; ++first) {
    for (int second = 0; second < 24; ++second) {
      std::vector<Eigen::Vector3d> lines;
      for (const int number : {first, second}) {
        const double angle = 0.26179938779914941 * number;  // 15 degrees
        const double x = 0.1 + (number % 7) * 1.1 / kFocal, y = -0.05 + 0.15 * (number % 5 - 2) / kFocal;
        lines.emplace_back(std::cos(angle), std::sin(angle), -std::cos(angle) * x - std::sin(angle) * y);
      }
      const TileRow coverage = polygon_row(lines, rays);
      for (int i = 0; i < kRayTile; ++i) {
        std::vector<PixelLine> through;
        bool out = false;
        for (const Eigen::Vector3d& line : lines) {
          const PixelLine at{line.x() * rays.x[i] + line.y() * rays.y[i] + line.z(),
                             line.x() * rays.dxdu[i] + line.y() * rays.dydu[i],
                             line.x() * rays.dxdv[i] + line.y() * rays.dydv[i]};
          const double reach = 0.5 * (std::abs(at.gx) + std::abs(at.gy));
          out = out || at.s <= -reach;
          if (at.s < reach) through.push_back(at);
        }
        // The area of the square that is left, from its corners: to some roundings.
        const double wanted = out ? 0.0 : through.empty() ? 1.0 : convex_coverage(through);
        CHECK(std::abs(coverage[i] - wanted) < 1e-11);
        outside += out ? 1 : 0;
        whole += !out && through.empty() ? 1 : 0;
        once += !out && through.size() == 1 ? 1 : 0;
        twice += !out && through.size() == 2 ? 1 : 0;
      }
    }
  }
  CHECK(std::min({once, twice, outside, whole}) > 100);  // each of the cases was met
}

using namespace glidelab::render;

namespace {

/// The same by 400 x 400 points.
double by_points(const std::vector<PixelLine>& lines) {
  int inside = 0;
  for (int i = 0; i < 160'000; ++i) {
    const double x = (i % 400 + 0.5) / 400.0 - 0.5;
    const double y = (i / 400 + 0.5) / 400.0 - 0.5;
    bool in_all = true;
    for (const PixelLine& line : lines) in_all = in_all && line.s + line.gx * x + line.gy * y > 0.0;
    inside += in_all ? 1 : 0;
  }
  return inside / 160'000.0;
}

/// The part of the pixel on the inner side of one line, in closed form.
double half_plane_coverage(const PixelLine& line) {
  const double a = std::max(std::abs(line.gx), std::abs(line.gy));
  const double b = std::min(std::abs(line.gx), std::abs(line.gy));
  const double t = std::abs(line.s);
  const double corner = std::max(0.5 * (a + b) - t, 0.0);  // where the line cuts a corner off: a triangle
  const double beyond = t <= 0.5 * (a - b) ? 0.5 - t / a : corner * corner / std::max(2.0 * a * b, 1e-300);
  return line.s > 0.0 ? 1.0 - beyond : beyond;
}

}  // namespace

TEST_CASE("A line cuts the area off a pixel that points count, alone as among others") {
  // The grid is off by at most 1/400 along the line.
  for (const auto& [gx, gy] : {std::pair{1.0, 0.0}, {0.0, -2.0}, {0.7, 0.7}, {0.3, -1.1}, {-0.9, 0.05}}) {
    for (const double s : {-1.2, -0.5, -0.31, 0.0, 0.02, 0.4, 0.77, 2.0}) {
      const PixelLine line{s, gx, gy};
      CAPTURE(gx, gy, s);
      CHECK(std::abs(half_plane_coverage(line) - by_points({line})) < 1.5 / 400.0);
      CHECK(std::abs(convex_coverage(std::vector{line}) - half_plane_coverage(line)) < 1e-12);
    }
  }
}

TEST_CASE("Several lines leave the area that points count, nothing where they exclude each other") {
  const std::vector<std::vector<PixelLine>> cases = {
      {{0.1, 1.0, 0.0}, {0.2, 0.0, 1.0}},                     // a right angle
      {{0.1, 1.0, 0.1}, {0.1, 1.0, -0.1}},                    // nearly one line
      {{0.1, 1.0, 0.0}, {0.05, -1.0, 0.0}},                   // a strip of 0.15
      {{0.2, 1.0, 0.3}, {0.1, -1.0, 0.4}, {0.0, 0.1, -1.0}},  // a triangle
      {{-0.2, 1.0, 0.0}, {-0.2, -1.0, 0.0}},                  // nothing
  };
  for (const auto& lines : cases) CHECK(std::abs(convex_coverage(lines) - by_points(lines)) < 3.0 / 400.0);
  CHECK(convex_coverage(cases.back()) == 0.0);
  CHECK(std::abs(convex_coverage(cases[2]) - 0.15) < 1e-15);
}
