#include "sim/force/law_list.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "sim/motion/simulate.h"
#include "sim/oracle/closed_forms.h"
#include "tests/catch.h"
#include "tests/sim/bodies.h"
#include "tests/sim/quadrature.h"

using namespace glidelab;
using namespace glidelab::sim;
using tests::body;
using tests::kGravity;
using tests::times;

namespace {

constexpr double kMass = 0.4;  // kg

struct LawCase {
  std::string name;
  std::shared_ptr<const ForceTerm> term;
  std::function<double(double)> brake_n;  ///< written down anew: the force against the motion at speed > 0
};

std::vector<LawCase> dissipative_laws(double normal_n) {
  return {
      {"viscous", laws::viscous().with({0.9}), [](double v) { return 0.9 * v; }},
      {"coulomb", laws::coulomb().with({0.02}), [=](double) { return 0.02 * normal_n; }},
      {"quadratic", laws::quadratic().with({0.7}), [](double v) { return 0.7 * v * v; }},
      {"power_law 0.3", laws::power_law().with({0.3, 0.3}), [](double v) { return 0.3 * std::pow(v, 0.3); }},
      {"power_law 0.5", laws::power_law().with({0.5, 0.5}), [](double v) { return 0.5 * std::sqrt(v); }},
      {"power_law 0.9", laws::power_law().with({0.5, 0.9}), [](double v) { return 0.5 * std::pow(v, 0.9); }},
      {"power_law 1.5", laws::power_law().with({0.5, 1.5}), [](double v) { return 0.5 * v * std::sqrt(v); }},
      {"stribeck", laws::stribeck().with({0.02, 2.5, 0.15}),
       [=](double v) { return 0.02 * normal_n * (1.0 + 1.5 * std::exp(-v * v / 0.0225)); }},
      {"eddy_rolloff", laws::eddy_rolloff().with({1.1, 0.4}), [](double v) { return 1.1 * v / (1.0 + v * v / 0.16); }},
  };
}

}  // namespace

TEST_CASE("every force law opposes the motion on both sides alike and has the slope that it says") {
  const Contact contact{.mass_kg = kMass, .normal_n = 3.9};
  for (const LawCase& law : dissipative_laws(contact.normal_n)) {
    INFO(law.name);
    for (const double v : {0.01, 0.15, 0.4, 1.3}) {
      CHECK(std::abs(law.term->force_n(v, +1, contact) + law.brake_n(v)) < 1e-15);
      CHECK(law.term->force_n(-v, -1, contact) == -law.term->force_n(v, +1, contact));
      for (const int direction : {-1, +1}) {
        // Central difference with step 1e-6 v: truncation 1e-12 of the curvature scale (< 1e3), rounding 1e-16 / 1e-8.
        const double h = 1e-6 * v;
        const double difference = (law.term->force_n(direction * v + h, direction, contact) -
                                   law.term->force_n(direction * v - h, direction, contact)) /
                                  (2.0 * h);
        CHECK(std::abs(law.term->slope_n_s_m(direction * v, direction, contact) - difference) < 1e-7);
      }
    }
  }
  const auto constant = laws::constant().with({-0.2});
  CHECK(constant->force_n(0.7, +1, contact) == -0.2);
  CHECK(constant->force_n(-0.7, -1, contact) == -0.2);
  CHECK(constant->slope_n_s_m(0.7, +1, contact) == 0.0);
}

TEST_CASE("what holds at rest holds at least what it opposes to the first sliding") {
  const Contact contact{.mass_kg = kMass, .normal_n = 3.9};
  for (const LawCase& law : dissipative_laws(contact.normal_n)) {
    CHECK(law.term->holding_n(contact) >= std::abs(law.term->force_n(0.0, +1, contact)));
  }
  CHECK(laws::coulomb().with({0.1, 0.2})->holding_n(contact) == 0.2 * 3.9);
  CHECK(std::abs(laws::stribeck().with({0.1, 3.0, 0.2})->holding_n(contact) - 0.3 * 3.9) < 1e-15);
  CHECK(laws::viscous().with({1.0})->holding_n(contact) == 0.0);
  CHECK(laws::constant().with({1.0})->holding_n(contact) == 0.0);
}

TEST_CASE("with every law a glider launched upward stops when and where the integral of dv / a(v) says") {
  for (const double incline : {0.01, 0.075, 0.3}) {
    const double weight = kMass * kGravity * std::sin(incline);
    for (const LawCase& law : dissipative_laws(kMass * kGravity * std::cos(incline))) {
      INFO(law.name << " at " << incline);
      Body glider = body(kMass, incline);
      glider.forces = {law.term};
      const double v0 = 1.4;
      const auto seconds = [&](double speed) { return kMass / (weight + law.brake_n(speed)); };
      const double stop_s = tests::integrate(v0, seconds);
      const double distance_m = tests::integrate(v0, [&](double speed) { return speed * seconds(speed); });
      const Trajectory trajectory = simulate(glider, 0.5, -v0, std::vector<double>{2.0 * stop_s});
      REQUIRE(trajectory.changes.size() == 1);
      CHECK(std::abs(trajectory.changes[0].t_s - stop_s) < 1e-9);
      CHECK(std::abs(trajectory.changes[0].x_m - (0.5 - distance_m)) < 1e-10);
      CHECK(trajectory.changes[0].to == mode_at_rest(glider));
    }
  }
}

TEST_CASE("with every law a glider that is released downhill reaches a speed when the integral of dv / a(v) says") {
  const double incline = 0.2;
  const double weight = kMass * kGravity * std::sin(incline);
  for (const LawCase& law : dissipative_laws(kMass * kGravity * std::cos(incline))) {
    INFO(law.name);
    Body glider = body(kMass, incline);
    glider.forces = {law.term};
    const double speed = 0.3;  // below every v_lim here
    const auto seconds = [&](double v) { return kMass / (weight - law.brake_n(v)); };
    const double reached_s = tests::integrate(speed, seconds);
    const double distance_m = tests::integrate(speed, [&](double v) { return v * seconds(v); });
    const Trajectory trajectory = simulate(glider, 0.0, 0.0, std::vector<double>{reached_s});
    CHECK(std::abs(trajectory.states[0].v_m_s - speed) < 1e-10);
    CHECK(std::abs(trajectory.states[0].x_m - distance_m) < 1e-10);
  }
}

TEST_CASE("quadratic drag with Coulomb friction agrees with the tangent and hyperbolic tangent") {
  tests::Uniform uniform(5);
  for (int i = 0; i < 60; ++i) {
    const double incline = i % 4 == 0 ? 0.0 : uniform(-0.2, 0.3);
    const double mu = i % 3 == 0 ? 0.0 : uniform(0.0005, 0.2);
    const double q = std::pow(10.0, uniform(-3.0, 1.0));
    const double v0 = i % 5 == 0 ? 0.0 : uniform(-2.0, 2.0);
    const DryTrack track = dry_track(incline, mu, mu, kGravity);
    const Body glider = body(kMass, incline, laws::quadratic().with({q * kMass}), laws::coulomb().with({mu}));
    INFO("q " << q << " mu " << mu << " incline " << incline << " v0 " << v0);
    const Trajectory trajectory = simulate(glider, 0.1, v0, times(10.0, 0.05));
    double error = 0.0;
    for (const State& state : trajectory.states) {
      const State truth = quadratic_coulomb_motion(track, q, 0.1, v0, state.t_s);
      CHECK(state.mode == truth.mode);
      error = std::max(error, std::abs(state.x_m - truth.x_m));
    }
    CHECK(error < 1e-9);
    const std::optional<double> stop_s = quadratic_coulomb_stop_time_s(track, q, v0);
    if (stop_s && *stop_s < 10.0) {
      REQUIRE(trajectory.changes.size() == 1);
      CHECK(std::abs(trajectory.changes[0].t_s - *stop_s) < 1e-9);
    }
  }
}

TEST_CASE("a power law alone on a level track follows its closed form, and stops below n = 1 only") {
  for (const double n : {0.1, 0.3, 0.5, 0.8, 0.95, 1.0, 1.2, 2.0, 3.0, 5.0}) {
    for (const double v0 : {-1.5, 0.6}) {
      const double k = 1.3;
      INFO("n " << n << " v0 " << v0);
      const Trajectory trajectory =
          simulate(body(kMass, 0.0, laws::power_law().with({k * kMass, n})), 0.2, v0, times(10.0, 0.05));
      double error = 0.0;
      for (const State& state : trajectory.states) {
        const State truth = power_law_motion(k, n, 0.2, v0, state.t_s);
        CHECK(state.mode == truth.mode);
        error = std::max(error, std::abs(state.x_m - truth.x_m));
      }
      CHECK(error < 1e-9);
      const std::optional<double> stop_s = power_law_stop_time_s(k, n, v0);
      if (stop_s && *stop_s < 10.0) {
        REQUIRE(trajectory.changes.size() == 1);
        CHECK(trajectory.changes[0].to == Mode::stick);
        CHECK(std::abs(trajectory.changes[0].t_s - *stop_s) < 1e-9);
      } else {
        CHECK(trajectory.changes.empty());
      }
    }
  }
}

TEST_CASE("below n = 1 a viscous term beside the power law does not change that it stops in finite time") {
  // w = sqrt|v| obeys w' = -(c + k w) / 2 with c = 0.6 and k = 1.5, so w = 0 at t = 2/k ln(1 + k w0 / c).
  const Trajectory trajectory =
      simulate(body(kMass, 0.0, laws::viscous().with({1.5 * kMass}), laws::power_law().with({0.6 * kMass, 0.5})), 0.0,
               1.44, times(5.0, 0.1));
  REQUIRE(trajectory.changes.size() == 1);
  CHECK(std::abs(trajectory.changes[0].t_s - 2.0 / 1.5 * std::log(1.0 + 1.5 * 1.2 / 0.6)) < 1e-9);
  CHECK(trajectory.states.back().mode == Mode::stick);
}

TEST_CASE("eddy-current roll-off alone on a level track fulfils its implicit t(v) and x(v)") {
  const double k = 2.9;
  const double v_c = 0.5;
  for (const double v0 : {-2.0, 0.4, 1.5}) {
    const Trajectory trajectory =
        simulate(body(kMass, 0.0, laws::eddy_rolloff().with({k * kMass, v_c})), 0.1, v0, times(10.0, 0.1));
    CHECK(trajectory.changes.empty());
    for (const State& state : trajectory.states) {
      // At v -> 0 the time is ln v / k: an error of t is one of v / v, so it shows whether v is good relatively.
      CHECK(std::abs(eddy_rolloff_time_s(k, v_c, v0, state.v_m_s) - state.t_s) < 1e-9);
      CHECK(std::abs(0.1 + eddy_rolloff_distance_m(k, v_c, v0, state.v_m_s) - state.x_m) < 1e-9);
    }
  }
}
