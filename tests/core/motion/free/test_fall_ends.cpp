#include "core/motion/free/fall_ends.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include "core/motion/free/free_motion.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kFrame_s = 0.02, kFalling_m_s = 2.8;  // of a fall onto the floor

struct Drop {
  double step_s = 1.0 / 60.0;
  double terminal_m_s = 2.0;
  double noise_m = 1e-3;
  double release_s = 0.0;   ///< before 0: it has been falling for a while
  double launch_m_s = 0.0;  ///< thrown down: of the body at 0
};

/// A fall of 1.2 m with a drag in proportion to v, integrated in closed form; at rest before the release.
core::Motion falling(const Drop& drop, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, drop.noise_m);
  const double rate = kGravity_m_s2 / drop.terminal_m_s;
  const auto place = [&](double t_s) {
    const double u = std::max(0.0, t_s - drop.release_s);
    const double of_launch = drop.launch_m_s * (1.0 - std::exp(-rate * u)) / rate;
    return of_launch + drop.terminal_m_s * (u - (1.0 - std::exp(-rate * u)) / rate);
  };
  core::Motion motion;
  motion.step_s = drop.step_s;
  motion.noise_m = drop.noise_m;
  for (std::size_t i = 0; i < 150; ++i) {
    const double t_s = drop.step_s * static_cast<double>(i);
    if (place(t_s) - place(0.0) > 1.2) break;
    motion.t_s.push_back(t_s);
    motion.x_m.push_back(place(t_s) + normal(random));
    motion.point.push_back(i);
  }
  motion.y_m = motion.x_m;
  return motion;
}

/// A fall from rest, braked in proportion to v² (closed form), and the floor below it.
core::Motion fall_onto_floor(std::size_t free, std::size_t on_floor, double noise_m, double step_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise_m);
  const auto fallen = [](double t_s) {
    return kFalling_m_s * kFalling_m_s / kGravity_m_s2 * std::log(std::cosh(kGravity_m_s2 * t_s / kFalling_m_s));
  };
  const double floor_m = fallen(kFrame_s * (static_cast<double>(free) - 0.6));  // between two frames
  core::Motion motion;
  for (std::size_t i = 0; i < free + on_floor; ++i) {
    motion.t_s.push_back(kFrame_s * static_cast<double>(i));
    double x = std::min(fallen(motion.t_s.back()), floor_m) + normal(random);
    if (step_m > 0.0) x = step_m * std::round(x / step_m);
    motion.x_m.push_back(x);
  }
  motion.y_m = motion.x_m;
  motion.step_s = kFrame_s;
  motion.noise_m = std::max(noise_m, step_m / std::sqrt(12.0));
  return motion;
}

core::Motion upwards(core::Motion motion) {
  for (double& x : motion.x_m) x = -x;
  motion.y_m = motion.x_m;
  return motion;
}

}  // namespace

TEST_CASE("a body that is held for a few positions falls freely from the first one after its release") {
  for (const double step_s : {1.0 / 30.0, 1.0 / 60.0, 1.0 / 120.0}) {
    for (const double terminal_m_s : {0.9, 2.0, 8.0}) {
      for (const std::size_t held : {2, 3, 5, 12}) {
        for (unsigned seed = 1; seed <= 10; ++seed) {
          INFO(1.0 / step_s << " fps, " << terminal_m_s << " m/s, held for " << held << ", seed " << seed);
          const double noise_m = 0.02 * kGravity_m_s2 * step_s * step_s;  // clear within a step
          const double last_s = step_s * static_cast<double>(held - 1);
          const core::Motion motion =
              falling({step_s, terminal_m_s, noise_m, last_s + (0.1 + 0.08 * seed) * step_s}, seed);
          CHECK(core::released_at(motion, 1, motion.t_s.size()) == held);
          CHECK(core::released_at(upwards(motion), -1, motion.t_s.size()) == held);
        }
      }
    }
  }
}

TEST_CASE("no position is cut of a body that has been released, or thrown down, before the first one") {
  std::size_t cut = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    for (const double terminal_m_s : {0.9, 2.0, 8.0}) {
      for (const double noise_m : {1e-4, 1e-3, 5e-3}) {
        for (const double before_s : {0.0, 0.03, 0.3}) {
          const Drop early{1.0 / 60.0, terminal_m_s, noise_m, -before_s};
          const Drop thrown{1.0 / 60.0, terminal_m_s, noise_m, 0.0, 4.0 * before_s};
          for (const Drop& drop : {early, thrown}) {
            const core::Motion motion = falling(drop, seed);
            cut += core::released_at(motion, 1, motion.t_s.size()) != 0;
          }
        }
      }
    }
  }
  CHECK(cut == 0);
}

TEST_CASE("a hand that lowers a body does not hold it") {
  // The body falls at a part of gravity until 0.19 s, and freely from there on.
  constexpr double kStep_s = 1.0 / 120.0, kUntil_s = 0.19;
  for (const double part : {0.25, 0.5, 0.75}) {
    for (const double launch_m_s : {0.0, 0.1, 0.3}) {
      for (unsigned seed = 1; seed <= 20; ++seed) {
        CAPTURE(part, launch_m_s, seed);
        std::mt19937 random(seed);
        std::normal_distribution<double> normal(0.0, 1e-3);
        core::Motion motion;
        motion.step_s = kStep_s;
        motion.noise_m = 1e-3;
        const double lowered_m_s2 = part * kGravity_m_s2;
        for (std::size_t i = 0; i < 72; ++i) {
          const double t_s = kStep_s * static_cast<double>(i), free_s = std::max(0.0, t_s - kUntil_s);
          const double x_m = launch_m_s * t_s + 0.5 * lowered_m_s2 * t_s * t_s +
                             0.5 * (kGravity_m_s2 - lowered_m_s2) * free_s * free_s;
          motion.t_s.push_back(t_s);
          motion.x_m.push_back(x_m + normal(random));
        }
        CHECK(core::released_at(motion, 1, motion.t_s.size()) == 0);
      }
    }
  }
}

TEST_CASE("a hand that opens slowly has not let go at once") {
  // It bears the weight until 0.05 s and a part of it, which falls to 0, for 0.1 s more; the drag is quadratic.
  constexpr double kStep_s = 0.01, kInner_s = 1e-5, kHeld_s = 0.05, kOpens_s = 0.1, kTerminal_m_s = 1.6;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1e-3);
    core::Motion motion;
    motion.step_s = kStep_s;
    motion.noise_m = 1e-3;
    double x_m = 0.0, v_m_s = 0.0, t_s = 0.0;
    for (std::size_t i = 0; i < 100; ++i) {
      motion.t_s.push_back(kStep_s * static_cast<double>(i));
      motion.x_m.push_back(x_m + normal(random));
      for (; t_s < kStep_s * static_cast<double>(i + 1); t_s += kInner_s) {
        const double free = std::clamp((t_s - kHeld_s) / kOpens_s, 0.0, 1.0);
        v_m_s += kInner_s * kGravity_m_s2 * (free - v_m_s * v_m_s / (kTerminal_m_s * kTerminal_m_s));
        x_m += kInner_s * v_m_s;
      }
    }
    CHECK(core::released_at(motion, 1, motion.t_s.size()) == 0);
  }
}

TEST_CASE("a fall of few positions after its release is cut there, or not at all, and the search for it ends") {
  std::size_t cut = 0, all = 0;
  for (const std::size_t after : {8, 9, 10, 12, 15}) {
    for (const double step_s : {1.0 / 30.0, 1.0 / 60.0}) {
      for (unsigned seed = 1; seed <= 6; ++seed) {
        CAPTURE(after, step_s, seed);
        core::Motion motion = falling({step_s, 50.0, 2e-4, 2.5 * step_s}, seed);
        REQUIRE(motion.t_s.size() >= 3 + after);
        for (std::vector<double>* of : {&motion.t_s, &motion.x_m, &motion.y_m}) of->resize(3 + after);
        motion.point.resize(3 + after);
        const std::size_t from = core::released_at(motion, 1, motion.t_s.size());
        CHECK((from == 0 || from == 3));
        cut += from == 3 ? 1 : 0;
        ++all;
      }
    }
  }
  CHECK(4 * cut > 3 * all);
  // Nothing but the last position shows that it fell.
  core::Motion last = falling({1.0 / 60.0, 2.0, 1e-4, 0.1}, 1);
  for (std::size_t i = 0; i + 1 < last.x_m.size(); ++i) last.x_m[i] = 0.0;
  CHECK(core::released_at(last, 1, last.t_s.size()) == 0);
}

TEST_CASE("a fall is fitted from its release on, without a margin") {
  const core::Motion motion = falling({1.0 / 60.0, 2.0, 2e-4, 2.5 / 60.0}, 1);
  core::ClipSetup setup;
  setup.incline_rad = 1.5707963267948966;
  setup.mass_kg = 1e-3;
  const core::FreeMotion free = core::find_free_motion(motion, setup);
  REQUIRE(free.reason.size() == motion.t_s.size());
  for (const std::size_t held : {0, 1, 2}) CHECK(free.reason[held] == core::LeftOut::rest);
  CHECK(free.reason[3] == core::LeftOut::used);
  const auto blocks = core::free_blocks(motion, free, {}, 3.0 / 60.0);
  REQUIRE(blocks.size() == 1);
  CHECK(blocks.front().t_s.front() == motion.t_s[3]);
  // What is stated is followed.
  setup.start_s = 0.0;
  CHECK(core::find_free_motion(motion, setup).reason[0] == core::LeftOut::used);
}

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
    const double t_s = kFrame_s * static_cast<double>(i);
    for (core::Motion* motion : {&bead, &ball}) motion->t_s.push_back(motion->t_s.back() + kFrame_s);
    bead.x_m.push_back(bead.x_m[29] + 0.5 * t_s);
    ball.x_m.push_back(ball.x_m[29] - 2.0 * t_s + 0.5 * kGravity_m_s2 * t_s * t_s);
  }
  CHECK(core::landed_from(bead, 1) == 45);
  CHECK(core::landed_from(ball, 1) == 45);
  // Too few steps before to know the speed.
  const core::Motion few = fall_onto_floor(4, 3, 1e-4, 0.0, 1);
  CHECK(core::landed_from(few, 1) == 7);
}
