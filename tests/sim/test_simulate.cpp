#include "sim/simulate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "bodies.h"
#include "catch.h"
#include "sim/closed_forms.h"

using namespace glidelab;
using namespace glidelab::sim;
using tests::body;
using tests::kGravity;
using tests::times;

namespace {

double mechanical_energy_j(const Body& body, const State& state) {
  return 0.5 * body.mass_kg * state.v_m_s * state.v_m_s - weight_along_track_n(body) * state.x_m;
}

double largest_position_error_m(const Body& body, const DryTrack& track, double k, double x0, double v0,
                                const std::vector<double>& at_s, const SolverOptions& options) {
  const Trajectory trajectory = simulate(body, x0, v0, at_s, options);
  double largest = 0.0;
  for (const State& state : trajectory.states) {
    largest = std::max(largest, std::abs(state.x_m - viscous_coulomb_motion(track, k, x0, v0, state.t_s).x_m));
  }
  return largest;
}

}  // namespace

TEST_CASE("equation (8) agrees with its closed form: position within 1e-9 m over 10 s, reversal within 1e-9 s") {
  tests::Uniform uniform(2);
  const std::vector<double> at_s = times(10.0, 0.02);
  int reversals = 0;
  for (const double k : {0.0, 1e-9, 1e-3, 0.1, 1.0, 2.77, 30.0, 1000.0}) {
    for (int i = 0; i < 24; ++i) {
      // mu from 1e-4 on: what comes to rest at a = mu g = 1e-3 m/s² has its time to 1e-9 s if v is good to 1e-12 m/s.
      const double mu = i % 5 == 0 ? 0.0 : std::pow(10.0, uniform(-4.0, -0.3));
      const double incline = i % 4 == 0 ? 0.0 : uniform(-0.2, 0.3);
      const double mass = uniform(0.1, 2.0);
      const double v0 = i % 7 == 0 ? 0.0 : uniform(-2.0, 2.0);
      const Body glider = body(mass, incline, ViscousForce(k * mass), CoulombForce(mu));
      const DryTrack track = dry_track(incline, mu, mu, kGravity);
      INFO("k " << k << " mu " << mu << " incline " << incline << " mass " << mass << " v0 " << v0);
      const Trajectory trajectory = simulate(glider, 0.3, v0, at_s);
      double position_error = 0.0;
      double speed_error = 0.0;
      std::size_t other_mode = 0;
      for (const State& state : trajectory.states) {
        const State truth = viscous_coulomb_motion(track, k, 0.3, v0, state.t_s);
        position_error = std::max(position_error, std::abs(state.x_m - truth.x_m));
        speed_error = std::max(speed_error, std::abs(state.v_m_s - truth.v_m_s));
        other_mode += state.mode == truth.mode ? 0 : 1;
      }
      CHECK(position_error < 1e-9);
      CHECK(speed_error < 1e-9);
      CHECK(other_mode == 0);
      const std::optional<double> stop_s = viscous_coulomb_stop_time_s(track, k, v0);
      if (stop_s && *stop_s < 10.0) {
        ++reversals;
        REQUIRE(trajectory.changes.size() == 1);
        CHECK(std::abs(trajectory.changes[0].t_s - *stop_s) < 1e-9);
      } else {
        CHECK(trajectory.changes.empty());
      }
    }
  }
  CHECK(reversals > 80);  // the spread holds both kinds
}

TEST_CASE("tightening the tolerance reduces the error") {
  const double k = 2.768;
  const Body glider = body(0.335, 0.075, ViscousForce(k * 0.335), CoulombForce(0.0071));
  const DryTrack track = dry_track(0.075, 0.0071, 0.0071, kGravity);
  double before = std::numeric_limits<double>::infinity();
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const double error = largest_position_error_m(glider, track, k, 0.2, -1.3, times(4.0, 0.01),
                                                  {.relative_tolerance = tolerance, .absolute_tolerance = tolerance});
    INFO("tolerance " << tolerance << " error " << error);
    // The global error of BDF goes with tolerance^(q/(q+1)), q = 5: 46 times less for a hundredth. Steps and orders are
    // chosen in jumps, hence a margin of 9.
    CHECK(error < before / 5.0);
    CHECK(error < 100.0 * tolerance);
    before = error;
  }
}

TEST_CASE("kinetic energy, potential energy and dissipated energy balance") {
  tests::Uniform uniform(3);
  for (int i = 0; i < 30; ++i) {
    const double mass = uniform(0.1, 2.0);
    const Body glider = body(mass, uniform(-0.2, 0.2), ViscousForce(mass * uniform(0.0, 5.0)),
                             CoulombForce(uniform(0.0, 0.1)), QuadraticForce(mass * uniform(0.0, 2.0)));
    const double v0 = uniform(-2.0, 2.0);
    const Trajectory trajectory = simulate(glider, 0.1, v0, times(3.0, 0.05));
    const double start_j = mechanical_energy_j(glider, {0.0, 0.1, v0, 0.0, Mode::stick});
    const double end_j = mechanical_energy_j(glider, trajectory.states.back());
    // dE = m v dv + m g dx <= 2 kg (2 m/s + 2 m/s²·s) 1e-10 beside the error of the integral itself.
    CHECK(std::abs(end_j - start_j + trajectory.dissipated_j) < 1e-9);
    CHECK(trajectory.dissipated_j > 0.0);
  }
}

TEST_CASE("energy never rises under dissipative laws") {
  const std::vector<Body> bodies = {body(0.3, 0.05, ViscousForce(0.9), CoulombForce(0.01)),
                                    body(0.3, 0.05, QuadraticForce(0.5)),
                                    body(0.3, 0.05, PowerLawForce(0.4, 0.5)),
                                    body(0.3, 0.05, PowerLawForce(0.4, 1.5)),
                                    body(0.3, -0.05, StribeckForce(0.02, 2.0, 0.1)),
                                    body(0.3, 0.0, EddyRolloffForce(0.9, 0.4)),
                                    body(0.3, 0.05, EddyRolloffForce(0.9, 0.4), CoulombForce(0.06))};
  for (const Body& glider : bodies) {
    for (const double v0 : {-1.5, 0.0, 1.5}) {
      const Trajectory trajectory = simulate(glider, 0.0, v0, times(3.0, 0.01));
      double before = std::numeric_limits<double>::infinity();
      for (const State& state : trajectory.states) {
        const double energy_j = mechanical_energy_j(glider, state);
        CHECK(energy_j <= before + 1e-11);  // the error of x and v, as above
        before = energy_j;
      }
    }
  }
}

TEST_CASE("the mirrored track gives the mirrored motion") {
  for (const double v0 : {-1.3, 0.0, 1.2}) {
    const Body glider = body(0.335, 0.075, ViscousForce(0.927), CoulombForce(0.0071));
    const Body mirrored = body(0.335, -0.075, ViscousForce(0.927), CoulombForce(0.0071));
    const Trajectory one = simulate(glider, 0.2, v0, times(3.0, 0.05));
    const Trajectory other = simulate(mirrored, -0.2, -v0, times(3.0, 0.05));
    REQUIRE(one.changes.size() == other.changes.size());
    for (std::size_t i = 0; i < one.states.size(); ++i) {
      // Every operation changes sign only: equal to the last bit.
      CHECK(one.states[i].x_m == -other.states[i].x_m);
      CHECK(one.states[i].v_m_s == -other.states[i].v_m_s);
      CHECK(static_cast<int>(one.states[i].mode) == -static_cast<int>(other.states[i].mode));
    }
  }
}

TEST_CASE("a motion restarted from any of its states goes on as it did") {
  const Body glider = body(0.335, 0.075, ViscousForce(0.927), CoulombForce(0.0071), QuadraticForce(0.1));
  const std::vector<double> at_s = times(3.0, 0.1);
  const Trajectory whole = simulate(glider, 0.2, -1.3, at_s);
  for (const std::size_t middle : {1U, 5U, 6U, 20U}) {
    const State& start = whole.states[middle];
    std::vector<double> rest_s;
    for (std::size_t i = middle; i < at_s.size(); ++i) rest_s.push_back(at_s[i] - at_s[middle]);
    const Trajectory rest = simulate(glider, start.x_m, start.v_m_s, rest_s);
    for (std::size_t i = 0; i < rest_s.size(); ++i) {
      // Each of the two is good to some 1e-11 m (first test of this file).
      CHECK(std::abs(rest.states[i].x_m - whole.states[middle + i].x_m) < 1e-10);
      CHECK(rest.states[i].mode == whole.states[middle + i].mode);
    }
  }
}

TEST_CASE("the states do not depend on which other times are asked for") {
  const Body glider = body(0.335, 0.075, ViscousForce(0.927), CoulombForce(0.0071));
  const Trajectory coarse = simulate(glider, 0.2, -1.3, times(2.0, 0.1));
  const Trajectory fine = simulate(glider, 0.2, -1.3, times(2.0, 0.0001));
  for (std::size_t i = 0; i < coarse.states.size(); ++i) {
    // The first step is chosen by the first time asked for; both are good to some 1e-11 m.
    CHECK(std::abs(coarse.states[i].x_m - fine.states[1000 * i].x_m) < 1e-10);
    CHECK(std::abs(coarse.states[i].v_m_s - fine.states[1000 * i].v_m_s) < 1e-10);
  }
}

TEST_CASE("viscous drag on a level track never comes to rest, makes no root and no endless loop") {
  const Body glider = body(0.3, 0.0, ViscousForce(15.0));
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
    const Trajectory trajectory = simulate(body(0.3, incline, CoulombForce(0.01)), 0.1, 0.0, at_s);
    CHECK(trajectory.changes.empty());
    CHECK(trajectory.states[0].mode == Mode::slide_down);
    const double a = kGravity * (std::sin(incline) - 0.01 * std::cos(incline));
    CHECK(std::abs(trajectory.states[0].a_m_s2 - a) < 1e-15);
    CHECK(std::abs(trajectory.states[4].x_m - (0.1 + 0.5 * a)) < 1e-12);
  }
  SECTION("uphill under a force that pulls it") {
    const Trajectory trajectory = simulate(body(0.3, incline, CoulombForce(0.01), ConstantForce(-0.5)), 0.1, 0.0, at_s);
    CHECK(trajectory.states[0].mode == Mode::slide_up);
    CHECK(trajectory.states[4].v_m_s < 0.0);
  }
  SECTION("not at all on a level track") {
    const Trajectory trajectory = simulate(body(0.3, 0.0, ViscousForce(0.5)), 0.1, 0.0, at_s);
    CHECK(trajectory.states[4].mode == Mode::stick);
    CHECK(trajectory.states[4].x_m == 0.1);
    CHECK(trajectory.dissipated_j == 0.0);
  }
  SECTION("not at all where friction holds exactly as much as the load") {
    const Trajectory trajectory = simulate(body(0.3, incline, CoulombForce(std::tan(incline))), 0.1, 0.0, at_s);
    CHECK(trajectory.states[4].mode == Mode::stick);
  }
  SECTION("not at all where a force balances gravity") {
    const Body glider = body(0.3, incline, ConstantForce(-0.3 * kGravity * std::sin(incline)));
    CHECK(simulate(glider, 0.1, 0.0, at_s).states[4].mode == Mode::stick);
  }
}

TEST_CASE("static friction above sliding friction holds a glider that sliding friction would let go on") {
  const double incline = 0.05;
  const double mu = 0.8 * std::tan(incline);
  const Body held = body(0.3, incline, CoulombForce(mu, 1.1 * std::tan(incline)));
  const Trajectory stopped = simulate(held, 0.0, -1.0, times(10.0, 0.5));
  REQUIRE(stopped.changes.size() == 1);
  CHECK(stopped.changes[0].to == Mode::stick);
  for (const State& state : stopped.states) {
    if (state.t_s < stopped.changes[0].t_s) continue;
    CHECK(state.x_m == stopped.changes[0].x_m);  // stick stays put, exactly
    CHECK(state.v_m_s == 0.0);
    CHECK(state.a_m_s2 == 0.0);
  }
  const Body let_go = body(0.3, incline, CoulombForce(mu, 0.9 * std::tan(incline)));
  CHECK(simulate(let_go, 0.0, -1.0, times(10.0, 0.5)).changes[0].to == Mode::slide_down);
  // Launched downhill it is slowed down by neither: static friction does not act on what moves.
  CHECK(simulate(held, 0.0, 0.1, times(10.0, 0.5)).changes.empty());
}

TEST_CASE("a time that is the instant of a reversal shows the mode after it") {
  // v = 1 m/s - 1 m/s² t, exactly 0 at t = 1 s; then it turns, for nothing holds it.
  const Body glider = body(1.0, 0.0, ConstantForce(-1.0));
  const Trajectory trajectory = simulate(glider, 0.0, 1.0, std::vector<double>{0.5, 1.0, 1.5});
  REQUIRE(trajectory.changes.size() == 1);
  CHECK(std::abs(trajectory.changes[0].t_s - 1.0) < 1e-12);
  CHECK(trajectory.states[1].mode == Mode::slide_up);
  CHECK(trajectory.states[1].v_m_s == 0.0);
  CHECK(std::abs(trajectory.states[2].v_m_s + 0.5) < 1e-12);
}

TEST_CASE("extreme starts and times are simulated as they stand") {
  const Body glider = body(0.3, 0.0, ViscousForce(0.9), CoulombForce(0.01));
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
  const Body glider = body(0.3, 0.0, CoulombForce(0.01));
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
