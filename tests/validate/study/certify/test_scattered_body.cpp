#include "validate/study/certify/scattered_body.h"

#include <cmath>
#include <numbers>

#include "sim/force/law_list.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

constexpr double kMass_kg = 0.25;
constexpr double kRounding = 1e-12;  // m/s², of accelerations up to 10 m/s²

sim::Body body_at(double incline_deg) {
  sim::Body body;
  body.mass_kg = kMass_kg;
  body.incline_rad = incline_deg * std::numbers::pi / 180.0;
  body.forces = {sim::laws::viscous().with({0.6}), sim::laws::coulomb().with({0.05})};
  return body;
}

double acceleration(const sim::Body& body, double v_m_s, int direction) {
  return sim::net_force_n(body, v_m_s, direction) / body.mass_kg;
}

}  // namespace

TEST_CASE("an inclination that scatters changes the acceleration by what is asked, at every inclination and sign") {
  for (const double deg : {0.0, 4.0, 80.0, 88.0, 89.0, 89.4, 90.0, -90.0}) {
    for (const double asked : {0.05, 0.2, -0.2}) {
      const sim::Body before = body_at(deg), after = scattered(before, {.incline_m_s2 = asked});
      for (const int direction : {1, -1}) {
        INFO(deg << " degrees, " << asked << " m/s^2, direction " << direction);
        CHECK(std::abs(acceleration(after, 0.7 * direction, direction) -
                       acceleration(before, 0.7 * direction, direction) - asked) < kRounding);
      }
    }
  }
}

TEST_CASE("a friction that scatters acts along the motion, and in a fall it is a constant force") {
  const double asked = 0.03;
  for (const double deg : {4.0, 70.0, 80.0, 89.0, 90.0}) {
    const sim::Body before = body_at(deg), after = scattered(before, {.friction_m_s2 = asked});
    CHECK(falls(before) == (deg >= 80.0));
    for (const int direction : {1, -1}) {
      INFO(deg << " degrees, direction " << direction);
      const double wanted = falls(before) ? asked : asked * direction;
      CHECK(std::abs(acceleration(after, 0.7 * direction, direction) -
                     acceleration(before, 0.7 * direction, direction) - wanted) < kRounding);
    }
  }
  // Friction takes energy: more than all of it cannot be taken away. mu g cos(alpha) is 0.49 m/s² at 4 degrees.
  const sim::Body none = scattered(body_at(4.0), {.friction_m_s2 = 5.0});
  CHECK(std::abs(acceleration(none, 0.0, 1) - acceleration(none, 0.0, -1)) < kRounding);
}

TEST_CASE("a drag that scatters is that part of K, and in a fall of the quadratic drag as well") {
  for (const double deg : {4.0, 89.0}) {
    INFO(deg << " degrees");
    sim::Body before = body_at(deg);
    before.forces.push_back(sim::laws::quadratic().with({0.4}));
    before.forces.push_back(sim::laws::power_law().with({0.1, 0.5}));
    const sim::Body after = scattered(before, {.drag = 0.25});
    const double v = 2.0, c_kg_m = falls(before) ? 0.4 : 0.0;
    const double wanted = 0.25 * (0.6 * v + c_kg_m * v * v) / kMass_kg;
    CHECK(std::abs(acceleration(after, v, 1) - acceleration(before, v, 1) - wanted) < kRounding);
    CHECK(std::abs(drag_rate_1_s(before, -v) - (0.6 + 2.0 * 0.4 * v) / kMass_kg) < kRounding);
  }
}
