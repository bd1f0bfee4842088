#include "sim/motion/motion_scenario.h"

#include <cmath>

#include "sim/motion/simulate.h"
#include "tests/catch.h"
#include "tests/sim/bodies.h"

using namespace glidelab;
using namespace glidelab::sim;
using tests::body;
using tests::kGravity;

TEST_CASE("K/m and mu are given where the law is viscous and Coulomb, and only there") {
  const auto law = linear_law(
      body(0.5, 0.1, laws::viscous().with({1.5}), laws::coulomb().with({0.01, 0.02}), laws::viscous().with({0.5})));
  REQUIRE(law);
  CHECK(law->k_over_m_1_s == 4.0);
  CHECK(law->mu == 0.01);
  REQUIRE(linear_law(body(0.5, 0.1)));
  CHECK(linear_law(body(0.5, 0.1))->mu == 0.0);
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::viscous().with({1.5}), laws::constant().with({0.1}))));
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::stribeck().with({0.1, 1.0, 0.1}))));
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::quadratic().with({0.1}))));
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::power_law().with({0.1, 1.0}))));
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::eddy_rolloff().with({0.1, 1.0}))));
}

TEST_CASE("the limit speed is equation (9) for viscous and Coulomb friction, to rounding") {
  const double incline = 0.075;
  const double expected = (0.335 * kGravity * (std::sin(incline) - 0.0071 * std::cos(incline))) / 0.927;
  const auto v_lim =
      limit_speed_m_s(body(0.335, incline, laws::viscous().with({0.927}), laws::coulomb().with({0.0071})));
  REQUIRE(v_lim);
  CHECK(std::abs(*v_lim - expected) < 1e-15);
}

TEST_CASE("the limit speed of every other law is where its force balances gravity") {
  const double weight = 0.4 * kGravity * std::sin(0.1);
  CHECK(std::abs(*limit_speed_m_s(body(0.4, 0.1, laws::quadratic().with({0.7}))) - std::sqrt(weight / 0.7)) < 1e-15);
  CHECK(std::abs(*limit_speed_m_s(body(0.4, 0.1, laws::power_law().with({0.7, 0.5}))) - weight / 0.7 * weight / 0.7) <
        1e-15);
  // v / (1 + v²/v_c²) = w has v = v_c (v_c - sqrt(v_c² - 4 w²)) / (2 w) as its stable root.
  const double w = weight / 2.0;
  const double stable = (1.0 - std::sqrt(1.0 - 4.0 * w * w)) / (2.0 * w);
  CHECK(std::abs(*limit_speed_m_s(body(0.4, 0.1, laws::eddy_rolloff().with({2.0, 1.0}))) - stable) < 1e-15);
  // Stribeck and viscous: the net force vanishes there and a glider comes to it.
  const Body stribeck = body(0.4, 0.1, laws::stribeck().with({0.05, 1.8, 0.1}), laws::viscous().with({0.5}));
  const double v_lim = *limit_speed_m_s(stribeck);
  CHECK(std::abs(net_force_n(stribeck, v_lim, +1)) < 1e-15);
  for (const double v0 : {0.0, 0.3, 1.5}) {
    CHECK(std::abs(simulate(stribeck, 0.0, v0, std::vector<double>{60.0}).states[0].v_m_s - v_lim) < 1e-10);
  }
}

TEST_CASE("a stable speed that a resting glider never reaches is the limit speed of a moving one") {
  // Held at rest by 1.2 tan(alpha), driven above the dip of the Stribeck curve.
  const double mu = 0.4 * std::tan(0.1);
  const Body glider = body(0.4, 0.1, laws::stribeck().with({mu, 3.0, 0.1}), laws::viscous().with({0.2}));
  const double v_lim = *limit_speed_m_s(glider);
  CHECK(mode_at_rest(glider) == Mode::stick);
  CHECK(std::abs(simulate(glider, 0.0, 0.8, std::vector<double>{60.0}).states[0].v_m_s - v_lim) < 1e-10);
}

TEST_CASE("there is no limit speed on a level track, uphill, without a drag, or where friction holds") {
  CHECK_FALSE(limit_speed_m_s(body(0.4, 0.0, laws::viscous().with({1.0}))));
  CHECK_FALSE(limit_speed_m_s(body(0.4, -0.1, laws::viscous().with({1.0}))));
  CHECK_FALSE(limit_speed_m_s(body(0.4, 0.1, laws::coulomb().with({0.01}))));
  CHECK_FALSE(limit_speed_m_s(body(0.4, 0.1, laws::viscous().with({1.0}), laws::coulomb().with({0.2}))));
  CHECK_FALSE(limit_speed_m_s(body(0.4, 0.1, laws::viscous().with({1.0}), laws::coulomb().with({std::tan(0.1)}))));
  CHECK_FALSE(
      limit_speed_m_s(body(0.4, 0.4, laws::eddy_rolloff().with({1.0, 0.5}))));  // stronger than the brake's peak
}
