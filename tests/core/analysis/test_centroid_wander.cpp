#include "core/analysis/centroid_wander.h"

#include <cmath>
#include <numbers>
#include <random>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kScatter_m = 1e-4;

/// Two centroids that differ by a constant, by a wave over the path and by scatter, in 240 frames over 0.6 m.
std::vector<core::CentroidShift> shifts(double wave_m, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> scatter(0.0, kScatter_m);
  std::vector<core::CentroidShift> made;
  for (int i = 0; i < 240; ++i) {
    const double part = i / 239.0;
    made.push_back({0.6 * part - 0.2, 2e-3 + wave_m * std::cos(2.0 * std::numbers::pi * part) + scatter(random)});
  }
  return made;
}

}  // namespace

TEST_CASE("centroids that differ by a constant and by scatter do not wander") {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) found += core::centroid_wander(shifts(0.0, seed)) ? 1 : 0;
  CHECK(found <= 8);  // 200 at a hundredth each: 2, sd 1.4
}

TEST_CASE("a wave between two centroids is the size of the wander, over its four modes") {
  const double wave_m = 2e-4;
  const auto wander = core::centroid_wander(shifts(wave_m, 3));
  REQUIRE(wander);
  // One of four modes has all of it; the amplitude's scatter is 1e-4 sqrt(2 / 240) = 0.9e-5.
  CHECK(wander->sd_m == Approx(0.5 * wave_m).margin(1e-5));
  CHECK(wander->at(0, -0.2) == Approx(wander->sd_m));
  CHECK(wander->at(0, 0.4) == Approx(-wander->sd_m));
  CHECK(wander->at(1, 0.1) == Approx(-wander->sd_m));  // half way
  CHECK(std::abs(wander->at(2, 0.1)) < 1e-9);
}

TEST_CASE("few frames, or a marker at rest, tell nothing of a wander") {
  CHECK_FALSE(core::centroid_wander({}));
  std::vector<core::CentroidShift> at_rest = shifts(2e-4, 3);
  for (core::CentroidShift& shift : at_rest) shift.x_m = 0.1;
  CHECK_FALSE(core::centroid_wander(at_rest));
  std::vector<core::CentroidShift> few = shifts(2e-4, 3);
  few.resize(20);
  CHECK_FALSE(core::centroid_wander(few));
}
