#include "diagnose/pictures/image_search.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("A wave is found with its frequency, and white noise has none", "[pictures]") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::size_t alarms = 0;
  for (int seed = 0; seed < 20; ++seed) {
    std::vector<diagnose::Series> noise(4);
    for (auto& series : noise) {
      for (int k = 0; k < 150; ++k) {
        series.t_s.push_back(k / 120.0);
        series.value.push_back(normal(random));
      }
    }
    if (diagnose::strongest_wave(noise).log_evidence > 0.0) ++alarms;
    for (auto& series : noise) {
      for (std::size_t k = 0; k < series.value.size(); ++k) {
        series.value[k] += 0.8 * std::sin(2.0 * std::numbers::pi * 13.0 * series.t_s[k] + seed);
      }
    }
    const diagnose::SeriesWave wave = diagnose::strongest_wave(noise);
    CHECK(wave.log_evidence > 3.0);
    // A fourth of a peak's width is the grid; 5 sd of the frequency, each series telling by itself.
    CHECK(std::abs(wave.f_hz - 13.0) < 0.25 / 1.25 + 5.0 * wave.sd_hz);
  }
  CHECK(alarms == 0);  // the penalty leaves less than 1 in 100
}

TEST_CASE("Evidence of a deviation falls below nothing at none and grows with its square", "[pictures]") {
  CHECK(diagnose::log_deviation_evidence(0.0, 100.0) < -1.0);
  CHECK(diagnose::log_deviation_evidence(10.0, 100.0) > 40.0);
  CHECK(diagnose::log_deviation_evidence(10.0, 100.0) < 50.0);  // z²/2 less what the unknown size costs
  CHECK(diagnose::log_deviation_evidence(-10.0, 100.0) < diagnose::log_deviation_evidence(0.0, 100.0));
}

TEST_CASE("pure noise gives a deviation of either sign a mean Bayes factor of one", "[pictures]") {
  // Midpoint rule; the integrand is a sum of normal densities about 1 to 10 on either side, so that 25 and steps of
  // 0.01 hold it to 1e-10.
  double mean = 0.0;
  for (double z = -24.995; z < 25.0; z += 0.01) {
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    mean += 0.01 * density * std::exp(diagnose::log_either_sign_evidence(z, 10.0));
  }
  CHECK(std::abs(mean - 1.0) < 1e-8);
  CHECK(diagnose::log_either_sign_evidence(-4.0, 10.0) == Approx(diagnose::log_either_sign_evidence(4.0, 10.0)));
  const double one_side = diagnose::log_deviation_evidence(8.0, 10.0);
  CHECK(diagnose::log_either_sign_evidence(8.0, 10.0) == Approx(one_side - std::log(2.0)).epsilon(1e-6));
}
