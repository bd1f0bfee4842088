#include "core/pictures/scene/path_light.h"

#include <cmath>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kDiameter_m = 0.03;

/// A marker that runs uphill over a metre and back, 100 frames either way, in light as a function of x, with noise.
template <class Light>
std::vector<core::LitPoint> path(Light&& light, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise);
  std::vector<core::LitPoint> points;
  for (std::size_t k = 0; k < 200; ++k) {
    const double s = std::abs(static_cast<double>(k) / 100.0 - 1.0), x_m = 0.5 - (1.0 - s);
    points.push_back({k, x_m, 120.0 * light(x_m) * (1.0 + normal(random))});
  }
  return points;
}

double shadow_at(double edge_m, double light, double x_m, double soft_m) {
  return 1.0 + (light - 1.0) * 0.5 * (1.0 + std::erf((x_m - edge_m) / soft_m));
}

}  // namespace

TEST_CASE("a shadow's edge is found at its place, at every crossing, with what it takes of the light") {
  const auto points = path([](double x) { return shadow_at(0.1, 0.65, x, 0.005); }, 0.005, 1);
  const std::vector<core::LightEdge> edges = core::edges_of_light(points, kDiameter_m);
  REQUIRE(edges.size() == 2);
  for (const core::LightEdge& edge : edges) {
    CHECK(std::abs(edge.x_m - 0.1) < 0.5 * kDiameter_m);
    // Means of three frames each: 0.005 * sqrt(2/3) of the light, five times; the rest is the soft edge (1e-5).
    CHECK(std::abs(edge.fall - 0.35) < 0.021);
    CHECK(edge.downhill);
  }
  // x = 0.1 m in frames 40 and 160, 0.01 m from one to the next: those within 0.015 m of the place that was found.
  CHECK(edges[0].first_frame >= 37);
  CHECK(edges[0].last_frame <= 43);
  CHECK(edges[1].first_frame >= 157);
  CHECK(edges[1].last_frame <= 163);
  const auto mirrored =
      core::edges_of_light(path([](double x) { return shadow_at(0.1, 0.65, -x, 0.005); }, 0.005, 1), kDiameter_m);
  REQUIRE(mirrored.size() == 2);
  CHECK(std::abs(mirrored[0].x_m + 0.1) < 0.5 * kDiameter_m);
  CHECK_FALSE(mirrored[0].downhill);
}

TEST_CASE("a gradient, a soft penumbra, stripes and noise are no shadow's edge") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    CHECK(core::edges_of_light(path([](double x) { return std::exp(-1.4 * x); }, 0.01, seed), kDiameter_m).empty());
    // Three quarters of the light are lost over some ten diameters.
    CHECK(core::edges_of_light(path([](double x) { return shadow_at(0.0, 0.25, x, 0.3); }, 0.005, seed), kDiameter_m)
              .empty());
    CHECK(core::edges_of_light(path([](double x) { return 1.0 + 0.2 * std::sin(60.0 * x); }, 0.005, seed), kDiameter_m)
              .empty());
    CHECK(core::edges_of_light(path([](double) { return 1.0; }, 0.02, seed), kDiameter_m).empty());
  }
}

TEST_CASE("the slope of the light is that of ln(brightness), beside a shadow's edge as well") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    const std::vector<std::vector<core::LitPoint>> clips = {
        path([](double x) { return std::exp(-0.15 * x); }, 0.01, seed)};
    const auto slope = core::slope_of_light(clips, {}, kDiameter_m);
    REQUIRE(slope);
    // With a diameter of the path as one value the standard deviation is that of white noise times sqrt(200 / 33).
    CHECK(std::abs(slope->per_m + 0.15) < 3.0 * slope->sd_per_m);
    CHECK(std::abs(slope->sd_per_m / (0.01 * std::sqrt(12.0 / 33.3)) - 1.0) < 0.2);
    const auto even = core::slope_of_light({path([](double) { return 1.0; }, 0.01, seed)}, {}, kDiameter_m);
    CHECK((!even || std::abs(even->per_m) < 3.0 * even->sd_per_m));
  }
  const auto beside = core::slope_of_light(
      {path([](double x) { return std::exp(-0.15 * x) * shadow_at(0.1, 0.65, x, 0.005); }, 0.0, 1)}, {0.1},
      kDiameter_m);
  REQUIRE(beside);
  CHECK(std::abs(beside->per_m + 0.15) < 3.0 * beside->sd_per_m);
  // It falls to both sides: no slope.
  CHECK_FALSE(core::slope_of_light({path([](double x) { return 1.0 - 0.4 * x * x; }, 0.0, 1)}, {}, kDiameter_m));
}

TEST_CASE("a gradient displaces the centroid of a disc as the integral over its area says") {
  constexpr double kRadius = 10.0, kSlope = 0.002;
  double light = 0.0, moment = 0.0;
  for (double v = -kRadius; v <= kRadius; v += 0.05) {
    for (double u = -kRadius; u <= kRadius; u += 0.05) {
      if (u * u + v * v > kRadius * kRadius) continue;
      light += 1.0 + kSlope * u;
      moment += u * (1.0 + kSlope * u);
    }
  }
  // The sum errs by the cells that the outline cuts: 0.05 / 10.
  CHECK(std::abs(core::displacement_by_slope(kSlope, kRadius) / (moment / light) - 1.0) < 0.01);
}
