#include "diagnose/model/turning_waves.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("waves that are turned on are those of each frequency, after a thousand steps as well") {
  const std::vector<double> z = {-0.7, 0.0, 0.013, 0.4, 1.9};
  diagnose::TurningWaves waves(z, 3.0, 0.17);
  for (int step = 0; step <= 1000; ++step, waves.turn()) {
    if (step % 100 != 0) continue;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double turn = 2.0 * std::numbers::pi * (3.0 + 0.17 * step) * z[i];
      INFO("step " << step << ", z = " << z[i]);
      // A thousand roundings of 1e-16, and that of an angle of 2000 rad.
      CHECK(std::abs(waves.sin()[static_cast<Eigen::Index>(i)] - std::sin(turn)) < 2e-12);
      CHECK(std::abs(waves.cos()[static_cast<Eigen::Index>(i)] - std::cos(turn)) < 2e-12);
    }
  }
}
