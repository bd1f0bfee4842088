#include "diagnose/noise/position_rounding.h"

#include <cmath>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// A cart that rolls down and comes to 1.5 m in 2 s, in positions of 50 Hz.
diagnose::TrackedMotion rolling(double noise_m, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  diagnose::TrackedMotion motion;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.02 * i;
    motion.t_s.push_back(t);
    motion.x_m.push_back(0.137 + 0.2 * t + 0.3 * t * t + noise_m * normal(random));
  }
  motion.sd_m = noise_m;
  return motion;
}

diagnose::TrackedMotion rounded(diagnose::TrackedMotion motion, double step_m, double from_m = 0.0) {
  for (double& x : motion.x_m) x = from_m + step_m * std::round(x / step_m);
  motion.sd_m = std::max(motion.sd_m, step_m / std::sqrt(12.0));
  return motion;
}

}  // namespace

TEST_CASE("positions that are rounded tell their step, whatever it is and wherever they count from") {
  for (const double step : {0.01, 0.005, 0.0123, 0.001, 0.0254}) {
    for (const double from : {0.0, -0.7312345}) {
      INFO(step << " from " << from);
      const auto found = diagnose::rounding_step_m(rounded(rolling(1e-4, 1), step, from));
      REQUIRE(found);
      // A hundred multiples that are each right to the rounding of a double.
      CHECK(std::abs(*found - step) < 1e-9);
    }
  }
}

TEST_CASE("a text of eight digits, and inches that were converted, keep the step") {
  diagnose::TrackedMotion motion = rounded(rolling(1e-4, 2), 0.01);
  for (double& x : motion.x_m) x = static_cast<double>(static_cast<float>(x));  // 0.33 becomes 0.33000001
  REQUIRE(diagnose::rounding_step_m(motion));
  // Floats near 1 m err by 6e-8 m, over a hundred steps.
  CHECK(std::abs(*diagnose::rounding_step_m(motion) - 0.01) < 6e-8);
}

TEST_CASE("where every difference is two steps or three, the step is still the common one") {
  diagnose::TrackedMotion motion;
  double x = 0.2;
  for (int i = 0; i < 40; ++i) {
    motion.t_s.push_back(0.05 * i);
    motion.x_m.push_back(x);
    x += i % 3 == 0 ? 0.02 : 0.03;
  }
  motion.sd_m = 0.003;
  REQUIRE(diagnose::rounding_step_m(motion));
  CHECK(std::abs(*diagnose::rounding_step_m(motion) - 0.01) < 1e-12);
  for (double& one : motion.x_m) one = 0.2 + 2.0 * (one - 0.2);  // only even multiples: that is the step
  CHECK(std::abs(*diagnose::rounding_step_m(motion) - 0.02) < 1e-12);
}

TEST_CASE("positions as a camera has them, many digits, or too few values have no step") {
  for (unsigned seed = 1; seed <= 20; ++seed) CHECK_FALSE(diagnose::rounding_step_m(rolling(1e-4, seed)));
  // Hundredths of a millimetre with a noise of 0.1 mm: the step is lost in it.
  diagnose::TrackedMotion printed = rolling(1e-4, 3);
  for (double& x : printed.x_m) x = std::round(x * 1e5) / 1e5;
  CHECK_FALSE(diagnose::rounding_step_m(printed));
  printed.sd_m = 2e-5;
  REQUIRE(diagnose::rounding_step_m(printed));
  CHECK(std::abs(*diagnose::rounding_step_m(printed) - 1e-5) < 1e-9);
  CHECK_FALSE(diagnose::rounding_step_m(rounded(rolling(1e-4, 1), 0.5)));  // four values
  CHECK_FALSE(diagnose::rounding_step_m(diagnose::TrackedMotion{}));
}

TEST_CASE("a set is rounded where each of its motions is, to the coarsest of their steps") {
  diagnose::TrackSet set;
  CHECK_FALSE(diagnose::rounding_step_m(set));
  set.motions = {rounded(rolling(1e-4, 1), 0.005), rounded(rolling(1e-4, 2), 0.01)};
  REQUIRE(diagnose::rounding_step_m(set));
  CHECK(std::abs(*diagnose::rounding_step_m(set) - 0.01) < 1e-9);
  set.motions.push_back(rolling(1e-4, 3));
  CHECK_FALSE(diagnose::rounding_step_m(set));
}
