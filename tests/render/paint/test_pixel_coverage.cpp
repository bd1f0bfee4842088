#include "render/paint/pixel_coverage.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/catch.h"

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
