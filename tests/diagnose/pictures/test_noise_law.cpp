#include "diagnose/pictures/twin_camera.h"

#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

namespace {

std::vector<core::NoiseAtLevel> levels_of(double dark, double gain) {
  std::vector<core::NoiseAtLevel> levels;
  for (double level = 10.0; level < 200.0; level += 30.0) {
    const double sd = std::sqrt(dark + gain * level);
    levels.push_back({level, sd, 0.01 * sd});
  }
  return levels;
}

}  // namespace

TEST_CASE("a straight line of variances is found, with how well", "[noise law]") {
  const auto law = diagnose::noise_law(levels_of(0.3, 0.01));
  REQUIRE(law);
  CHECK(law->gain_code == Approx(0.01));
  CHECK(law->dark_code2 == Approx(0.3));
  CHECK(law->at(100.0) == Approx(1.3));
  // A hundred times as well known points know the line a hundred times as well.
  auto sharper = levels_of(0.3, 0.01);
  for (core::NoiseAtLevel& one : sharper) one.known_to /= 100.0;
  CHECK(diagnose::noise_law(sharper)->gain_sd == Approx(law->gain_sd / 100.0));
}

TEST_CASE("neither light nor sensor has a variance below zero", "[noise law]") {
  auto falling = levels_of(2.0, 0.0);
  for (core::NoiseAtLevel& one : falling) one.sd_code -= 0.002 * one.level_code;
  CHECK(diagnose::noise_law(falling)->gain_code == 0.0);
  CHECK(diagnose::noise_law(falling)->dark_code2 > 0.0);
  auto steep = levels_of(0.0, 0.01);
  for (core::NoiseAtLevel& one : steep) one.sd_code *= one.level_code / 100.0;
  CHECK(diagnose::noise_law(steep)->dark_code2 == 0.0);
  CHECK(diagnose::noise_law(steep)->gain_code > 0.0);
}

TEST_CASE("of two levels, or one brightness, there is no law", "[noise law]") {
  auto levels = levels_of(0.3, 0.01);
  for (core::NoiseAtLevel& one : levels) one.level_code = 50.0;
  CHECK_FALSE(diagnose::noise_law(levels));
  levels.resize(2);
  CHECK_FALSE(diagnose::noise_law(levels));
}
