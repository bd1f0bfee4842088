#include "sim/motion/simulate.h"

#include <cmath>
#include <limits>
#include <string>

#include "base/errors.h"
#include "tests/catch.h"
#include "tests/sim/bodies.h"

using namespace glidelab;
using namespace glidelab::sim;
using tests::body;
using tests::kGravity;
using tests::times;

TEST_CASE("viscous drag on a level track never comes to rest, makes no root and no endless loop") {
  const Body glider = body(0.3, 0.0, laws::viscous().with({15.0}));
  for (const double v0 : {-1.5, 1.5}) {
    const Trajectory trajectory = simulate(glider, 0.0, v0, times(1000.0, 0.5));
    CHECK(trajectory.changes.empty());
    CHECK(trajectory.solver_steps < 20000);
    double before = std::abs(v0) * 1.1;
    for (const State& state : trajectory.states) {
      CHECK(state.mode == (v0 < 0.0 ? Mode::slide_up : Mode::slide_down));
      CHECK(state.v_m_s * v0 >= 0.0);  // 0 only where exp(-50 t) underflows
      CHECK(std::abs(state.v_m_s) <= before);
      before = std::abs(state.v_m_s);
    }
    CHECK(std::abs(trajectory.states[20].v_m_s / (v0 * std::exp(-500.0)) - 1.0) < 1e-9);  // relative, at 1e-217 m/s
    CHECK(std::abs(trajectory.states.back().x_m - v0 / 50.0) < 1e-12);
  }
}

TEST_CASE("a glider that is released starts as its load says") {
  const double incline = 0.05;
  const std::vector<double> at_s = times(1.0, 0.25);
  SECTION("downhill, from the first instant") {
    const Trajectory trajectory = simulate(body(0.3, incline, laws::coulomb().with({0.01})), 0.1, 0.0, at_s);
    CHECK(trajectory.changes.empty());
    CHECK(trajectory.states[0].mode == Mode::slide_down);
    const double a = kGravity * (std::sin(incline) - 0.01 * std::cos(incline));
    CHECK(std::abs(trajectory.states[0].a_m_s2 - a) < 1e-15);
    CHECK(std::abs(trajectory.states[4].x_m - (0.1 + 0.5 * a)) < 1e-12);
  }
  SECTION("uphill under a force that pulls it") {
    const Trajectory trajectory =
        simulate(body(0.3, incline, laws::coulomb().with({0.01}), laws::constant().with({-0.5})), 0.1, 0.0, at_s);
    CHECK(trajectory.states[0].mode == Mode::slide_up);
    CHECK(trajectory.states[4].v_m_s < 0.0);
  }
  SECTION("not at all on a level track") {
    const Trajectory trajectory = simulate(body(0.3, 0.0, laws::viscous().with({0.5})), 0.1, 0.0, at_s);
    CHECK(trajectory.states[4].mode == Mode::stick);
    CHECK(trajectory.states[4].x_m == 0.1);
    CHECK(trajectory.dissipated_j == 0.0);
  }
  SECTION("not at all where friction holds exactly as much as the load") {
    const Trajectory trajectory =
        simulate(body(0.3, incline, laws::coulomb().with({std::tan(incline)})), 0.1, 0.0, at_s);
    CHECK(trajectory.states[4].mode == Mode::stick);
  }
  SECTION("not at all where a force balances gravity") {
    const Body glider = body(0.3, incline, laws::constant().with({-0.3 * kGravity * std::sin(incline)}));
    CHECK(simulate(glider, 0.1, 0.0, at_s).states[4].mode == Mode::stick);
  }
}

TEST_CASE("static friction above sliding friction holds a glider that sliding friction would let go on") {
  const double incline = 0.05;
  const double mu = 0.8 * std::tan(incline);
  const Body held = body(0.3, incline, laws::coulomb().with({mu, 1.1 * std::tan(incline)}));
  const Trajectory stopped = simulate(held, 0.0, -1.0, times(10.0, 0.5));
  REQUIRE(stopped.changes.size() == 1);
  CHECK(stopped.changes[0].to == Mode::stick);
  for (const State& state : stopped.states) {
    if (state.t_s < stopped.changes[0].t_s) continue;
    CHECK(state.x_m == stopped.changes[0].x_m);  // stick stays put, exactly
    CHECK(state.v_m_s == 0.0);
    CHECK(state.a_m_s2 == 0.0);
  }
  const Body let_go = body(0.3, incline, laws::coulomb().with({mu, 0.9 * std::tan(incline)}));
  CHECK(simulate(let_go, 0.0, -1.0, times(10.0, 0.5)).changes[0].to == Mode::slide_down);
  // Launched downhill it is slowed down by neither: static friction does not act on what moves.
  CHECK(simulate(held, 0.0, 0.1, times(10.0, 0.5)).changes.empty());
}

TEST_CASE("a time that is the instant of a reversal shows the mode after it") {
  // v = v0 - a t with nothing that holds: 0 at v0 / a, where it turns. Most of these instants are not the double that
  // the solver finds, but one a few roundings away.
  for (const double a : {1.0, 0.3, 7.7}) {
    for (int i = 1; i <= 40; ++i) {
      const double v0 = 0.1 * i;
      INFO("a " << a << " v0 " << v0);
      const double turn_s = v0 / a;
      const Trajectory trajectory = simulate(body(1.0, 0.0, laws::constant().with({-a})), 0.0, v0,
                                             std::vector<double>{0.5 * turn_s, turn_s, 1.5 * turn_s});
      REQUIRE(trajectory.changes.size() == 1);
      CHECK(std::abs(trajectory.changes[0].t_s - turn_s) < 1e-12);
      CHECK(trajectory.states[0].mode == Mode::slide_down);
      CHECK(trajectory.states[1].mode == Mode::slide_up);
      CHECK(std::abs(trajectory.states[1].v_m_s) < 1e-13);  // 100 roundings of t, times a
      CHECK(std::abs(trajectory.states[2].v_m_s + 0.5 * v0) < 1e-12);
    }
  }
}

TEST_CASE("extreme starts and times are simulated as they stand") {
  const Body glider = body(0.3, 0.0, laws::viscous().with({0.9}), laws::coulomb().with({0.01}));
  for (const double v0 : {1e-300, -1e-100, 1e-30, -1e-15, 1e-9}) {
    for (const double first_s : {1e-320, 1e-200, 1e-90, 1e-30, 1e-16, 1e-9}) {
      INFO("v0 " << v0 << " first time " << first_s);
      const Trajectory trajectory = simulate(glider, 0.5, v0, std::vector<double>{0.0, first_s, 1e-3, 1.0});
      REQUIRE(trajectory.states.size() == 4);
      CHECK(std::abs(trajectory.states[0].v_m_s - v0) < 1e-100);  // slower than that counts as at rest
      CHECK(trajectory.states[3].mode == Mode::stick);
      REQUIRE(trajectory.changes.size() == 1);
      CHECK(std::abs(trajectory.states[3].x_m - 0.5) < 1e-13);
    }
  }
  CHECK(simulate(glider, 0.5, 1.0, {}).states.empty());
  // Two times next to one another.
  const double t = 0.7;
  const Trajectory close = simulate(glider, 0.5, 1.0, std::vector<double>{t, std::nextafter(t, 1.0)});
  CHECK(std::abs(close.states[0].x_m - close.states[1].x_m) < 1e-15);
}

TEST_CASE("times that do not rise and numbers that are not finite are refused by name") {
  const Body glider = body(0.3, 0.0, laws::coulomb().with({0.01}));
  const auto message = [&](const Body& of, double x0, double v0, std::vector<double> at_s, SolverOptions options = {}) {
    try {
      simulate(of, x0, v0, at_s, options);
    } catch (const base::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(message(glider, 0.0, 1.0, {0.0, 0.2, 0.2}).find("times_s[2]: found 0.2, expected a time later than 0.2") !=
        std::string::npos);
  CHECK(message(glider, 0.0, 1.0, {0.3, 0.1}).find("times_s[1]") != std::string::npos);
  CHECK(message(glider, 0.0, 1.0, {-0.1}).find("times_s[0]") != std::string::npos);
  CHECK(message(glider, 0.0, 1.0, {0.0, nan}).find("times_s[1]") != std::string::npos);
  CHECK(message(glider, 0.0, 1.0, {0.0, infinity}).find("times_s[1]") != std::string::npos);
  CHECK(message(glider, nan, 1.0, {0.0}).find("x0_m") != std::string::npos);
  CHECK(message(glider, 0.0, infinity, {0.0}).find("v0_m_s") != std::string::npos);
  CHECK(message(glider, 0.0, 1.0, {0.0}, {.relative_tolerance = 0.0}).find("tolerance") != std::string::npos);
  CHECK(message(body(0.0, 0.0), 0.0, 1.0, {0.0}).find("mass_kg") != std::string::npos);
  CHECK(message(body(0.3, nan), 0.0, 1.0, {0.0}).find("incline_rad") != std::string::npos);
  CHECK(message(glider, 0.0, 1.0, {0.0, 1.0}).empty());
}

TEST_CASE("modes have the names that the trajectory table uses") {
  CHECK(name_of(Mode::slide_up) == "slide_up");
  CHECK(name_of(Mode::stick) == "stick");
  CHECK(name_of(Mode::slide_down) == "slide_down");
}
