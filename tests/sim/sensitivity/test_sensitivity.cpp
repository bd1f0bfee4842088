/// Sensitivities against differences of the closed form of equation (8), which shares no code with them, and against
/// what CVODES integrates.
#include "sim/sensitivity/sensitivity.h"

#include <array>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "sim/oracle/closed_forms.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::sim;

namespace {

/// k, drive, friction, x0, v0.
using Parameters = std::array<double, 5>;

State closed(const Parameters& p, double t_s) {
  return viscous_coulomb_motion({p[1], p[2], p[2]}, p[0], p[3], p[4], t_s);
}

void compare(const Parameters& p, const std::vector<double>& times) {
  const TrackLaw law(p[0], p[1], p[2]);
  const std::vector<SensitiveState> states = simulate_sensitive(law, p[3], p[4], times);
  REQUIRE(states.size() == times.size());
  for (const SensitiveState& state : states) {
    const State truth = closed(p, state.t_s);
    INFO("t = " << state.t_s);
    CHECK(std::abs(state.x_m - truth.x_m) < 1e-9);
    CHECK(std::abs(state.v_m_s - truth.v_m_s) < 1e-9);
    CHECK(state.mode == truth.mode);
    for (int i = 0; i < 5; ++i) {
      // Central differences: error h² f'''/6 + rounding / h, below 1e-9 for h = 1e-5 and motions of this size.
      constexpr double kStep = 1e-5;
      Parameters more = p, less = p;
      more[static_cast<std::size_t>(i)] += kStep;
      less[static_cast<std::size_t>(i)] -= kStep;
      const State up = closed(more, state.t_s), down = closed(less, state.t_s);
      INFO("parameter " << i);
      CHECK(std::abs(state.by_parameter(0, i) - (up.x_m - down.x_m) / (2.0 * kStep)) < 1e-6);
      // Within a step of the instant of reversal the difference reaches over the jump.
      if (up.mode == down.mode) {
        CHECK(std::abs(state.by_parameter(1, i) - (up.v_m_s - down.v_m_s) / (2.0 * kStep)) < 1e-6);
      }
    }
  }
}

std::vector<double> times_to(double end_s) {
  std::vector<double> times;
  for (int i = 0; i <= 40; ++i) times.push_back(end_s * i / 40.0);
  return times;
}

}  // namespace

TEST_CASE("sensitivities of a motion that turns carry the jump at v = 0") {
  compare({2.768, 0.737, 0.0694, 0.2, -1.3}, times_to(1.7));
}

TEST_CASE("sensitivities of a motion that stops and sticks stay as they are from there on") {
  const Parameters p{0.9, 0.05, 0.12, -0.1, 0.4};
  compare(p, times_to(3.0));
  const std::vector<SensitiveState> states = simulate_sensitive(TrackLaw(p[0], p[1], p[2]), p[3], p[4], times_to(6.0));
  CHECK(states.back().mode == Mode::stick);
  CHECK(states.back().by_parameter.row(1).norm() == 0.0);
  CHECK(states.back().by_parameter.row(0) == states[states.size() - 2].by_parameter.row(0));
}

TEST_CASE("sensitivities of a motion in one direction, with and without damping, from rest too") {
  compare({1.7, 0.7, 0.04, -0.5, 1.2}, times_to(1.7));
  compare({0.0, 0.7, 0.04, -0.5, 1.2}, times_to(1.0));
  const std::vector<double> times = times_to(1.0);
  const auto states = simulate_sensitive(TrackLaw(2.0, 0.7, 0.05), 0.3, 0.0, times);
  const State end = closed({2.0, 0.7, 0.05, 0.3, 0.0}, 1.0);
  CHECK(std::abs(states.back().x_m - end.x_m) < 1e-9);
  // x = x0 + a0 t² phi2(-k t): by the drive and by minus the friction alike.
  CHECK(std::abs(states.back().by_parameter(0, 1) - phi2(-2.0)) < 1e-8);
  CHECK(std::abs(states.back().by_parameter(0, 2) + phi2(-2.0)) < 1e-8);
}

namespace {

std::vector<double> times(double step_s, int count) {
  std::vector<double> t_s;
  for (int i = 0; i < count; ++i) t_s.push_back(i * step_s);
  return t_s;
}

struct Case {
  const char* what;
  double k, drive, friction, x0, v0;
};

// Down, down from above v_lim, up and back, up and stuck, level and stuck, from rest, no damping, hardly any damping.
constexpr Case kCases[] = {{"down", 2.7, 0.73, 0.07, -0.2, 0.1},        {"fast down", 2.7, 0.73, 0.07, -0.2, 1.5},
                           {"up and back", 2.7, 0.73, 0.07, 0.5, -1.2}, {"up and stuck", 1.7, 0.05, 0.07, 0.5, -0.8},
                           {"level", 2.1, 0.002, 0.06, 0.0, 0.9},       {"from rest", 1.1, 0.4, 0.05, 0.1, 0.0},
                           {"no damping", 0.0, 0.5, 0.1, 0.0, -0.7},    {"hardly any", 1e-7, 0.5, 0.1, 0.0, -0.7}};

}  // namespace

TEST_CASE("the closed form's motion and derivatives are those that CVODES integrates, through stop and reversal") {
  const std::vector<double> t_s = times(0.01, 250);
  for (const Case& c : kCases) {
    const auto closed = track_motion_sensitive(c.k, c.drive, c.friction, c.x0, c.v0, t_s);
    const auto solved = simulate_sensitive(TrackLaw(c.k, c.drive, c.friction), c.x0, c.v0, t_s, {1e-12, 1e-13});
    REQUIRE(closed.size() == solved.size());
    for (std::size_t i = 0; i < closed.size(); ++i) {
      INFO(c.what << " at " << t_s[i] << " s");
      // The solver keeps 1e-12 a step; some hundred steps, and derivatives up to 10 in size.
      CHECK(std::abs(closed[i].x_m - solved[i].x_m) < 1e-9);
      CHECK(std::abs(closed[i].v_m_s - solved[i].v_m_s) < 1e-9);
      CHECK((closed[i].by_parameter - solved[i].by_parameter).cwiseAbs().maxCoeff() < 1e-7);
      CHECK(closed[i].mode == solved[i].mode);
    }
  }
}

TEST_CASE("the derivatives are the differences of the motion, also where it has turned") {
  const std::vector<double> t_s = {0.05, 0.3, 0.9, 2.0};
  for (const Case& c : kCases) {
    if (c.v0 == 0.0) continue;  // a step in v0 changes the way it starts
    const auto here = track_motion_sensitive(c.k, c.drive, c.friction, c.x0, c.v0, t_s);
    for (int p = 0; p < 5; ++p) {
      constexpr double kStep = 1e-6;
      double up[] = {c.k, c.drive, c.friction, c.x0, c.v0}, down[] = {c.k, c.drive, c.friction, c.x0, c.v0};
      up[p] += kStep;
      down[p] -= kStep;
      const auto above = track_motion_sensitive(up[0], up[1], up[2], up[3], up[4], t_s);
      const auto below = track_motion_sensitive(down[0], down[1], down[2], down[3], down[4], t_s);
      for (std::size_t i = 0; i < t_s.size(); ++i) {
        INFO(c.what << ", parameter " << p << " at " << t_s[i] << " s");
        // Rounding 1e-16 / 1e-6 beside a third derivative of some hundreds times 1e-12.
        CHECK(std::abs((above[i].x_m - below[i].x_m) / (2.0 * kStep) - here[i].by_parameter(0, p)) < 1e-8);
      }
    }
  }
}

TEST_CASE("numbers that are not finite are a numerical error") {
  const std::vector<double> t_s = {0.0, 1.0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(track_motion_sensitive(nan, 0.1, 0.1, 0.0, 1.0, t_s), base::NumericalError);
  CHECK_THROWS_AS(track_motion_sensitive(-1e6, 0.1, 0.1, 0.0, 1.0, t_s), base::NumericalError);
}
