#include <cmath>
#include <cstddef>
#include <random>

#include "core/motion/free/fall_ends.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kStep_s = 0.02, kTerminal_m_s = 2.8, kGravity_m_s2 = 9.81;

/// A fall from rest, braked in proportion to v² (closed form), and the floor below it.
core::Motion fall_onto_floor(std::size_t free, std::size_t on_floor, double noise_m, double step_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise_m);
  const auto fallen = [](double t_s) {
    return kTerminal_m_s * kTerminal_m_s / kGravity_m_s2 * std::log(std::cosh(kGravity_m_s2 * t_s / kTerminal_m_s));
  };
  const double floor_m = fallen(kStep_s * (static_cast<double>(free) - 0.6));  // between two frames
  core::Motion motion;
  for (std::size_t i = 0; i < free + on_floor; ++i) {
    motion.t_s.push_back(kStep_s * static_cast<double>(i));
    double x = std::min(fallen(motion.t_s.back()), floor_m) + normal(random);
    if (step_m > 0.0) x = step_m * std::round(x / step_m);
    motion.x_m.push_back(x);
  }
  motion.y_m = motion.x_m;
  motion.step_s = kStep_s;
  motion.noise_m = std::max(noise_m, step_m / std::sqrt(12.0));
  return motion;
}

core::Motion upwards(core::Motion motion) {
  for (double& x : motion.x_m) x = -x;
  return motion;
}

}  // namespace

TEST_CASE("a fall ends where the body lands, be it for one position or for several") {
  for (const std::size_t on_floor : {1, 2, 3, 4, 5, 40}) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      for (const double step_m : {0.0, 0.01}) {
        const core::Motion motion = fall_onto_floor(25, on_floor, 1e-3, step_m, seed);
        INFO(on_floor << " positions on the floor, rounded to " << step_m << " m, seed " << seed);
        CHECK(core::landed_from(motion, 1) == 25);
        CHECK(core::landed_from(upwards(motion), -1) == 25);  // x counted upwards
      }
    }
  }
}

TEST_CASE("no position of a free fall lies on the floor") {
  std::size_t cut = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    for (const double noise_m : {1e-4, 1e-3, 5e-3}) {
      const core::Motion motion = fall_onto_floor(40, 0, noise_m, seed % 2 == 0 ? 0.01 : 0.0, seed);
      cut += core::landed_from(motion, 1) != 40;
    }
  }
  CHECK(cut == 0);
  // A bead that falls into a liquid goes on at a lower speed, and a ball that bounces goes up.
  core::Motion bead = fall_onto_floor(30, 0, 1e-4, 0.0, 1), ball = fall_onto_floor(30, 0, 1e-4, 0.0, 1);
  for (std::size_t i = 1; i <= 15; ++i) {
    const double t_s = kStep_s * static_cast<double>(i);
    for (core::Motion* motion : {&bead, &ball}) motion->t_s.push_back(motion->t_s.back() + kStep_s);
    bead.x_m.push_back(bead.x_m[29] + 0.5 * t_s);
    ball.x_m.push_back(ball.x_m[29] - 2.0 * t_s + 0.5 * kGravity_m_s2 * t_s * t_s);
  }
  CHECK(core::landed_from(bead, 1) == 45);
  CHECK(core::landed_from(ball, 1) == 45);
  // Too few steps before to know the speed.
  const core::Motion few = fall_onto_floor(4, 3, 1e-4, 0.0, 1);
  CHECK(core::landed_from(few, 1) == 7);
}
