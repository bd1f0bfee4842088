#include "sim/sensitivity/sensitivity.h"

#include <cmath>
#include <limits>

#include "base/errors.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::sim;

namespace {

std::vector<double> times(double step_s, int count) {
  std::vector<double> t_s;
  for (int i = 0; i < count; ++i) t_s.push_back(i * step_s);
  return t_s;
}

struct Case {
  const char* what;
  double k, drive, friction, x0, v0;
};

// Down, down from above v_lim, up and back, up and stuck, level and stuck, from rest, no damping, hardly any damping.
constexpr Case kCases[] = {{"down", 2.7, 0.73, 0.07, -0.2, 0.1},        {"fast down", 2.7, 0.73, 0.07, -0.2, 1.5},
                           {"up and back", 2.7, 0.73, 0.07, 0.5, -1.2}, {"up and stuck", 1.7, 0.05, 0.07, 0.5, -0.8},
                           {"level", 2.1, 0.002, 0.06, 0.0, 0.9},       {"from rest", 1.1, 0.4, 0.05, 0.1, 0.0},
                           {"no damping", 0.0, 0.5, 0.1, 0.0, -0.7},    {"hardly any", 1e-7, 0.5, 0.1, 0.0, -0.7}};

}  // namespace

TEST_CASE("the closed form's motion and derivatives are those that CVODES integrates, through stop and reversal") {
  const std::vector<double> t_s = times(0.01, 250);
  for (const Case& c : kCases) {
    const auto closed = track_motion_sensitive(c.k, c.drive, c.friction, c.x0, c.v0, t_s);
    const auto solved = simulate_sensitive(TrackLaw(c.k, c.drive, c.friction), c.x0, c.v0, t_s, {1e-12, 1e-13});
    REQUIRE(closed.size() == solved.size());
    for (std::size_t i = 0; i < closed.size(); ++i) {
      INFO(c.what << " at " << t_s[i] << " s");
      // The solver keeps 1e-12 a step; some hundred steps, and derivatives up to 10 in size.
      CHECK(std::abs(closed[i].x_m - solved[i].x_m) < 1e-9);
      CHECK(std::abs(closed[i].v_m_s - solved[i].v_m_s) < 1e-9);
      CHECK((closed[i].by_parameter - solved[i].by_parameter).cwiseAbs().maxCoeff() < 1e-7);
      CHECK(closed[i].mode == solved[i].mode);
    }
  }
}

TEST_CASE("the derivatives are the differences of the motion, also where it has turned") {
  const std::vector<double> t_s = {0.05, 0.3, 0.9, 2.0};
  for (const Case& c : kCases) {
    if (c.v0 == 0.0) continue;  // a step in v0 changes the way it starts
    const auto here = track_motion_sensitive(c.k, c.drive, c.friction, c.x0, c.v0, t_s);
    for (int p = 0; p < 5; ++p) {
      constexpr double kStep = 1e-6;
      double up[] = {c.k, c.drive, c.friction, c.x0, c.v0}, down[] = {c.k, c.drive, c.friction, c.x0, c.v0};
      up[p] += kStep;
      down[p] -= kStep;
      const auto above = track_motion_sensitive(up[0], up[1], up[2], up[3], up[4], t_s);
      const auto below = track_motion_sensitive(down[0], down[1], down[2], down[3], down[4], t_s);
      for (std::size_t i = 0; i < t_s.size(); ++i) {
        INFO(c.what << ", parameter " << p << " at " << t_s[i] << " s");
        // Rounding 1e-16 / 1e-6 beside a third derivative of some hundreds times 1e-12.
        CHECK(std::abs((above[i].x_m - below[i].x_m) / (2.0 * kStep) - here[i].by_parameter(0, p)) < 1e-8);
      }
    }
  }
}

TEST_CASE("numbers that are not finite are a numerical error") {
  const std::vector<double> t_s = {0.0, 1.0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(track_motion_sensitive(nan, 0.1, 0.1, 0.0, 1.0, t_s), base::NumericalError);
  CHECK_THROWS_AS(track_motion_sensitive(-1e6, 0.1, 0.1, 0.0, 1.0, t_s), base::NumericalError);
}
