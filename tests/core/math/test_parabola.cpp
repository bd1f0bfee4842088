#include "core/math/parabola.h"

#include <vector>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("the parabola through positions at any times has their acceleration, and their speed at the middle") {
  std::vector<double> t_s, x;
  for (const double t : {10.0, 10.1, 10.15, 10.4, 10.5, 10.9, 11.0}) {
    t_s.push_back(t);
    x.push_back(3.0 - 2.0 * t + 0.5 * 7.0 * t * t);
  }
  const core::Parabola exact = core::parabola_through(t_s, x);
  CHECK(exact.a == Approx(7.0).epsilon(1e-9));
  CHECK(exact.v == Approx(-2.0 + 7.0 * 10.5).epsilon(1e-9));
  CHECK(exact.at(10.7) == Approx(3.0 - 2.0 * 10.7 + 0.5 * 7.0 * 10.7 * 10.7).epsilon(1e-9));
  // Of four positions at even times, d (1, -3, 3, -1) is what no parabola takes up.
  const core::Parabola off = core::parabola_through(std::vector{0.0, 1.0, 2.0, 3.0}, std::vector{0.2, -0.6, 0.6, -0.2});
  for (const double t : {0.0, 1.0, 2.0, 3.0}) CHECK(off.at(t) == Approx(0.0).margin(1e-12));
}
