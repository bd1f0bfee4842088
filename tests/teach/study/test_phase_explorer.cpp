#include "teach/study/phase_explorer.h"

#include <algorithm>
#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("the explorer's orbits are those of u' = 1 - u^n, -1 - u^n and -u^n") {
  const teach::PhaseExplorer explorer = teach::explore_phases();
  REQUIRE(explorer.laws.size() == 4);
  for (const teach::LawOrbits& law : explorer.laws) {
    const auto follows = [&](const teach::Orbit& orbit, double drive) {
      REQUIRE(orbit.size() >= 2);
      CHECK(orbit.back().distance == 0.0);
      for (const teach::OrbitPoint& point : orbit) {
        const double drag = law.exponent == 0.0 ? 0.0 : std::pow(point.u, law.exponent);
        // Where it comes to rest, u is 0 by the solver's event to 1e-9; elsewhere the slope is the law of this u.
        CHECK(std::abs(point.slope - (drive - drag)) <= 1e-12 * (1.0 + drag));
        const double bend = law.exponent == 0.0 ? 0.0 : -law.exponent * std::pow(point.u, law.exponent - 1.0);
        CHECK(std::abs(point.bend - bend * point.slope) <= 1e-12 * (1.0 + std::abs(bend * point.slope)));
      }
    };
    follows(law.rising, 1.0);
    follows(law.braking, -1.0);
    follows(law.free, 0.0);
    if (law.exponent > 0.0) follows(law.falling, 1.0);
    CHECK(law.braking.back().u == 0.0);
  }
}

TEST_CASE("the explorer's viscous orbits are exponentials, the quadratic ones hyperbolic") {
  const teach::PhaseExplorer explorer = teach::explore_phases();
  for (const teach::OrbitPoint& point : explorer.laws[0].rising) {
    CHECK(std::abs(point.u - -std::expm1(-point.tau)) < 1e-11);  // tolerances of 1e-13 over some thousand steps
  }
  for (const teach::OrbitPoint& point : explorer.laws[2].rising) {
    CHECK(std::abs(point.u - std::tanh(point.tau)) < 1e-11);
  }
  // From u0 to rest: ln(1 + u0) with a linear drag, atan(u0) with a quadratic one.
  CHECK(std::abs(explorer.laws[0].braking.back().tau - std::log1p(teach::kFastest)) < 1e-9);
  CHECK(std::abs(explorer.laws[2].braking.back().tau - std::atan(teach::kFastest)) < 1e-9);
}

TEST_CASE("the explorer's distances to rest keep their digits where the orbit began a million times farther off") {
  const teach::PhaseExplorer explorer = teach::explore_phases();
  // From u to rest: u - ln(1 + u) with a linear drag, ln(1 + u²) / 2 with a quadratic one. A page scales them by 2e4 m
  // where k is small, and u is then a hundredth: 1e-10 of the distance is 1e-10 m. The instant of rest is known to
  // 1e-13 or so of an orbit's unit of time, and at u the distance to it to as much of u.
  const auto agrees = [](double found, double expected, double u) {
    CHECK(std::abs(found - expected) <= 1e-10 * std::abs(expected) + 1e-12 * std::min(u, 1.0));
  };
  for (const teach::OrbitPoint& point : explorer.laws[0].braking) {
    agrees(point.distance, -(point.u - std::log1p(point.u)), point.u);
  }
  for (const teach::OrbitPoint& point : explorer.laws[2].braking) {
    agrees(point.distance, -0.5 * std::log1p(point.u * point.u), point.u);
  }
}
