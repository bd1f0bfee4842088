#include "sim/motion/simulate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "sim/oracle/closed_forms.h"
#include "tests/catch.h"
#include "tests/sim/bodies.h"

using namespace glidelab::sim;
using namespace glidelab;
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
      const Body glider = body(mass, incline, laws::viscous().with({k * mass}), laws::coulomb().with({mu}));
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

TEST_CASE("a body that falls at 90 degrees falls as a drag alone lets it, whatever friction it would have") {
  const double k = 4.0, v_lim = kGravity / k;
  const Body cup = body(0.002, 0.5 * std::numbers::pi, laws::viscous().with({k * 0.002}), laws::coulomb().with({0.3}));
  for (const State& state : simulate(cup, 0.1, 0.0, times(3.0, 0.02)).states) {
    CHECK(std::abs(state.x_m - (0.1 + v_lim * (state.t_s - (1.0 - std::exp(-k * state.t_s)) / k))) < 1e-9);
  }
}

TEST_CASE("tightening the tolerance reduces the error") {
  const double k = 2.768;
  const Body glider = body(0.335, 0.075, laws::viscous().with({k * 0.335}), laws::coulomb().with({0.0071}));
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
    const Body glider =
        body(mass, uniform(-0.2, 0.2), laws::viscous().with({mass * uniform(0.0, 5.0)}),
             laws::coulomb().with({uniform(0.0, 0.1)}), laws::quadratic().with({mass * uniform(0.0, 2.0)}));
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
  const std::vector<Body> bodies = {
      body(0.3, 0.05, laws::viscous().with({0.9}), laws::coulomb().with({0.01})),
      body(0.3, 0.05, laws::quadratic().with({0.5})),
      body(0.3, 0.05, laws::power_law().with({0.4, 0.5})),
      body(0.3, 0.05, laws::power_law().with({0.4, 1.5})),
      body(0.3, -0.05, laws::stribeck().with({0.02, 2.0, 0.1})),
      body(0.3, 0.0, laws::eddy_rolloff().with({0.9, 0.4})),
      body(0.3, 0.05, laws::eddy_rolloff().with({0.9, 0.4}), laws::coulomb().with({0.06}))};
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

TEST_CASE("any sum of laws that a scenario may name is simulated: energy balances, one reversal at most, no chatter") {
  tests::Uniform uniform(7);
  const auto decades = [&](double low, double high) { return std::pow(10.0, uniform(low, high)); };
  for (int i = 0; i < 400; ++i) {
    Body glider = body(decades(-3.0, 2.0), i % 3 == 0 ? 0.0 : uniform(-0.5, 1.0));
    const double mass = glider.mass_kg;
    const int terms = 1 + i % 3;
    for (int k = 0; k < terms; ++k) {
      switch (static_cast<int>(uniform(0.0, 7.0))) {
        case 0:
          glider.forces.push_back(laws::viscous().with({mass * decades(-6.0, 6.0)}));
          break;
        case 1:
          glider.forces.push_back(laws::coulomb().with({decades(-5.0, 1.0)}));
          break;
        case 2:
          glider.forces.push_back(laws::quadratic().with({mass * decades(-6.0, 4.0)}));
          break;
        case 3:
          glider.forces.push_back(laws::power_law().with({mass * decades(-4.0, 4.0), uniform(0.1, 5.0)}));
          break;
        case 4:
          glider.forces.push_back(laws::stribeck().with({decades(-4.0, 1.0), uniform(1.0, 20.0), decades(-5.0, 1.0)}));
          break;
        case 5:
          glider.forces.push_back(laws::eddy_rolloff().with({mass * decades(-4.0, 4.0), decades(-4.0, 2.0)}));
          break;
        default:
          glider.forces.push_back(laws::constant().with({mass * uniform(-10.0, 10.0)}));
          break;
      }
    }
    const double v0 = i % 4 == 0 ? 0.0 : (i % 2 == 0 ? 1.0 : -1.0) * decades(-6.0, 1.7);
    const double duration_s = decades(-1.0, 2.8);
    INFO(i << ", " << terms << " terms, v0 " << v0);
    const Trajectory trajectory = simulate(glider, 0.0, v0, times(duration_s, duration_s / 50.0));
    CHECK(trajectory.changes.size() <= 1);
    CHECK(trajectory.solver_steps < 20000);
    const double start_j = 0.5 * mass * v0 * v0;
    const double end_j = mechanical_energy_j(glider, trajectory.states.back());
    const double scale_j = std::max({start_j, std::abs(end_j), std::abs(trajectory.dissipated_j)});
    // x, v and the integral each relative to 1e-13 a step, a thousand steps, and absolute to 1e-14 a step.
    CHECK(std::abs(end_j - start_j + trajectory.dissipated_j) < 1e-8 * scale_j + 1e-10 * mass);
    std::size_t wrong_side = 0;
    for (const State& state : trajectory.states) wrong_side += static_cast<int>(state.mode) * state.v_m_s < -1e-12;
    CHECK(wrong_side == 0);
  }
}

TEST_CASE("the mirrored track gives the mirrored motion") {
  for (const double v0 : {-1.3, 0.0, 1.2}) {
    const Body glider = body(0.335, 0.075, laws::viscous().with({0.927}), laws::coulomb().with({0.0071}));
    const Body mirrored = body(0.335, -0.075, laws::viscous().with({0.927}), laws::coulomb().with({0.0071}));
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
  const Body glider =
      body(0.335, 0.075, laws::viscous().with({0.927}), laws::coulomb().with({0.0071}), laws::quadratic().with({0.1}));
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
  const Body glider = body(0.335, 0.075, laws::viscous().with({0.927}), laws::coulomb().with({0.0071}));
  const Trajectory coarse = simulate(glider, 0.2, -1.3, times(2.0, 0.1));
  const Trajectory fine = simulate(glider, 0.2, -1.3, times(2.0, 0.0001));
  for (std::size_t i = 0; i < coarse.states.size(); ++i) {
    // The first step is chosen by the first time asked for; both are good to some 1e-11 m.
    CHECK(std::abs(coarse.states[i].x_m - fine.states[1000 * i].x_m) < 1e-10);
    CHECK(std::abs(coarse.states[i].v_m_s - fine.states[1000 * i].v_m_s) < 1e-10);
  }
}

namespace {

constexpr double kLeast = 1e-12;  // m/s, as simulate() has it

// Central differences against the analytic Jacobian, with steps of 1e-6 of each variable: truncation of order 1e-12 and
// rounding of order 1e-16 / 1e-6 of the rates, which are below 100 here.
void check_jacobian(const Slide& slide, double v) {
  const Eigen::Vector3d y(0.3, slide.variable(v), 0.1);
  const Eigen::Matrix3d analytic = slide.jacobian(y);
  for (int j = 0; j < 3; ++j) {
    const double h = 1e-6 * std::abs(y[j]);
    Eigen::Vector3d high = y;
    Eigen::Vector3d low = y;
    high[j] += h;
    low[j] -= h;
    const Eigen::Vector3d difference = (slide.rate(high) - slide.rate(low)) / (2.0 * h);
    for (int i = 0; i < 3; ++i) {
      INFO("v " << v << " row " << i << " column " << j);
      CHECK(std::abs(analytic(i, j) - difference[i]) < 1e-7 * std::max(1.0, std::abs(analytic(i, j))));
    }
  }
}

}  // namespace

TEST_CASE("the Jacobian meets finite differences for every law, variable and direction") {
  const std::vector<Body> bodies = {
      body(0.3, 0.05, laws::viscous().with({0.9}), laws::coulomb().with({0.01})),              // w = v
      body(0.3, 0.05, laws::quadratic().with({0.7}), laws::constant().with({0.1})),            // w = v
      body(0.3, 0.05, laws::stribeck().with({0.02, 2.0, 0.2})),                                // w = v
      body(0.3, 0.05, laws::power_law().with({0.4, 0.5}), laws::eddy_rolloff().with({1, 1})),  // w = v
      body(0.3, 0.0, laws::power_law().with({0.4, 0.5}), laws::viscous().with({0.3})),         // w = sqrt|v|
      body(0.3, 0.0, laws::power_law().with({0.4, 0.8}), laws::quadratic().with({0.3})),       // w = |v|^0.2
      body(0.3, 0.0, laws::viscous().with({0.9}), laws::quadratic().with({0.3})),              // w = ln |v|
      body(0.3, 0.0, laws::eddy_rolloff().with({0.9, 0.3})),                                   // w = ln |v|
  };
  for (const Body& glider : bodies) {
    for (const double v : {0.02, 0.3, 1.7}) {
      check_jacobian(Slide(glider, +1, kLeast), v);
      check_jacobian(Slide(glider, -1, kLeast), -v);
    }
  }
}

TEST_CASE("the variable is a speed both ways") {
  for (const Body& glider :
       {body(0.3, 0.05, laws::viscous().with({0.9})), body(0.3, 0.0, laws::power_law().with({0.4, 0.5})),
        body(0.3, 0.0, laws::viscous().with({0.9}))}) {
    for (const int direction : {-1, +1}) {
      const Slide slide(glider, direction, kLeast);
      for (const double speed : {1e-12, 0.3, 2.0}) {
        // exp(ln v): the rounding of ln v, up to 28, times v.
        CHECK(std::abs(slide.speed_m_s(slide.variable(direction * speed)) / (direction * speed) - 1.0) < 1e-14);
      }
    }
  }
}

TEST_CASE("a step beyond the end of a power of the speed is rest") {
  const Body glider = body(0.3, 0.0, laws::power_law().with({0.4, 0.5}));
  for (const int direction : {-1, +1}) CHECK(Slide(glider, direction, kLeast).speed_m_s(-1e-3) == 0.0);
}

TEST_CASE("whether a slide stops follows from the force at v -> 0") {
  CHECK(Slide(body(0.3, 0.05, laws::viscous().with({0.9})), -1, kLeast).stops());
  CHECK_FALSE(Slide(body(0.3, 0.05, laws::viscous().with({0.9})), +1, kLeast).stops());
  CHECK(Slide(body(0.3, 0.05, laws::coulomb().with({0.2})), +1, kLeast).stops());
  CHECK_FALSE(Slide(body(0.3, 0.0, laws::viscous().with({0.9})), +1, kLeast).stops());
  CHECK_FALSE(Slide(body(0.3, 0.0, laws::quadratic().with({0.9})), -1, kLeast).stops());
  CHECK_FALSE(Slide(body(0.3, 0.0), +1, kLeast).stops());
  CHECK(Slide(body(0.3, 0.0, laws::power_law().with({0.9, 0.7})), +1, kLeast).stops());
  CHECK_FALSE(
      Slide(body(0.3, 0.0, laws::power_law().with({0.0, 0.7}), laws::viscous().with({1.0})), +1, kLeast).stops());
}

TEST_CASE("below the least speed an infinite slope becomes a finite one, and the force has no jump") {
  const Slide slide(body(0.3, 0.05, laws::power_law().with({0.4, 0.5})), -1, 1e-6);
  const double gap = slide.acceleration_m_s2(-1e-6) - slide.acceleration_m_s2(-1e-6 * (1.0 - 1e-9));
  CHECK(std::abs(gap) < 1e-11);  // 1e-9 of 0.4 N sqrt(1e-6) / 0.3 kg
  const Eigen::Matrix3d at_rest = slide.jacobian({0.0, 0.0, 0.0});
  CHECK(std::abs(at_rest(1, 1) + 0.4 / 0.3 * 1e-3 / 1e-6) < 1e-9);
}
