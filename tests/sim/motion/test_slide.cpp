#include "sim/motion/simulate.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/sim/bodies.h"

using namespace glidelab;
using namespace glidelab::sim;
using tests::body;

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
