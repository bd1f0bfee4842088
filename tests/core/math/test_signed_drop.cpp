#include "core/math/signed_drop.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kG = 9.81;

/// x = (v²/g) ln cosh(g t/v), positive downwards: from rest towards the terminal velocity v with quadratic drag.
double with_drag(double t_s, double v_m_s) {
  return v_m_s * v_m_s / kG * std::log(std::cosh(kG * t_s / v_m_s));
}

/// The drop has the sign in which x is counted, whichever way that is.
void check_sign(double until_s, const std::function<double(double)>& x) {
  std::vector<double> t_s, down, up;
  for (int i = 0; i * 0.01 <= until_s; ++i) {
    t_s.push_back(0.01 * i);
    down.push_back(x(t_s.back()));
    up.push_back(-down.back());
  }
  CHECK(core::signed_drop(t_s, down, kG) > 0.0);
  CHECK(core::signed_drop(t_s, up, kG) < 0.0);
}

}  // namespace

TEST_CASE("a body falls in the direction in which x is counted downwards, wherever it lands") {
  check_sign(1.0, [](double t) { return with_drag(t, 1.3); });
  check_sign(0.5, [](double t) { return 0.5 * kG * t * t; });
  // Thrown upwards at 4 m/s: it lands above its start, or is still on its way up at the end.
  check_sign(0.6, [](double t) { return -4.0 * t + 0.5 * kG * t * t; });
  check_sign(0.35, [](double t) { return -4.0 * t + 0.5 * kG * t * t; });
  // Faster than its terminal velocity of 1 m/s: it slows down, by less than g, and still goes down.
  check_sign(0.5, [](double t) { return t + 0.5 / 9.81 * (1.0 - std::exp(-9.81 * t)); });
  // It falls for 0.4 s and lies on the floor for 0.6 s: no parabola.
  check_sign(1.0, [](double t) { return 0.5 * kG * std::pow(std::min(t, 0.4), 2); });
}

TEST_CASE("a body that bounces falls in the direction of the acceleration between its bounces") {
  // It falls from 1.45 m; each bounce keeps 0.75 of the speed. At 30 frames a second, as a phone films it.
  const auto height_fallen = [](double t) {
    double v = std::sqrt(2.0 * kG * 1.45), flight_s = v / kG;
    if (t < flight_s) return 0.5 * kG * t * t;
    t -= flight_s;
    for (v *= 0.75; t > 2.0 * v / kG; v *= 0.75) t -= 2.0 * v / kG;
    return 1.45 - v * t + 0.5 * kG * t * t;
  };
  for (const double until_s : {0.8, 1.0, 1.2, 1.4, 1.6, 2.0}) {
    CAPTURE(until_s);
    std::vector<double> t_s, down, up;
    for (int i = 0; i / 30.0 <= until_s; ++i) {
      t_s.push_back(i / 30.0);
      down.push_back(height_fallen(t_s.back()));
      up.push_back(-down.back());
    }
    CHECK(core::signed_drop(t_s, down, kG) > 0.0);
    CHECK(core::signed_drop(t_s, up, kG) < 0.0);
  }
}
