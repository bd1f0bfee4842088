#include "sim/oracle/closed_forms.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/sim/bodies.h"

using namespace glidelab;
using namespace glidelab::sim;
using tests::kGravity;

namespace {

// v = dx/dt and a = dv/dt by central differences of step h = 1e-5 s. The truncation h²/6 |x'''| is below 1e-7 for the
// |x'''| <= 5e3 here, the rounding 2e-16 |x| / h below 1e-9 for |x| <= 50.
template <class Motion>
void check_derivatives(Motion&& motion, double t) {
  const double h = 1e-5;
  const auto before = motion(t - h);
  const auto at = motion(t);
  const auto after = motion(t + h);
  CHECK(std::abs((after.x_m - before.x_m) / (2.0 * h) - at.v_m_s) < 2e-7);
  CHECK(std::abs((after.v_m_s - before.v_m_s) / (2.0 * h) - at.a_m_s2) < 2e-7);
}

}  // namespace

TEST_CASE("phi1 and phi2 are exact at 0, near 0 and across every change of formula") {
  CHECK(phi1(0.0) == 1.0);
  CHECK(phi2(0.0) == 0.5);
  for (const double z : {1e-300, 1e-16, -1e-9, 1e-4}) {
    // Two terms more of the series: z²/6 and z²/24 relative to 1, kept because they are below 1e-15 only for |z| <
    // 1e-7.
    CHECK(std::abs(phi1(z) - (1.0 + z / 2.0 + z * z / 6.0 + z * z * z / 24.0)) < 1e-15);
    CHECK(std::abs(phi2(z) - (0.5 + z / 6.0 + z * z / 24.0 + z * z * z / 120.0)) < 1e-15);
  }
  // Both formulas of phi2 on either side of |z| = 1; the true change over 2e-15 is below 1e-15.
  for (const double z : {1.0, -1.0}) {
    CHECK(std::abs(phi2(z * (1.0 + 1e-15)) - phi2(z * (1.0 - 1e-15))) < 2e-15);
  }
  CHECK(std::abs(phi2(-50.0) - 49.0 / 2500.0) < 1e-16);  // e^-50 is lost in the rounding
}

TEST_CASE("equations (2) and (3) are the linear motion with v_lim = a0 / k, and start where they are told") {
  for (const double k : {0.1, 2.88, 40.0}) {
    for (const double t : {0.0, 0.01, 0.7, 10.0}) {
      const Kinematics with_limit = viscous_motion(k, 0.75 / k, 0.3, -1.1, t);
      const Kinematics with_force = linear_motion(0.75, k, 0.3, -1.1, t);
      // Rounding of terms of size v_lim t <= 75 m.
      CHECK(std::abs(with_limit.x_m - with_force.x_m) < 1e-13);
      CHECK(std::abs(with_limit.v_m_s - with_force.v_m_s) < 1e-13);
      CHECK(std::abs(with_limit.a_m_s2 - with_force.a_m_s2) < 1e-13);
    }
    const Kinematics start = viscous_motion(k, 0.75 / k, 0.3, -1.1, 0.0);
    CHECK(start.x_m == 0.3);
    CHECK(start.v_m_s == -1.1);
  }
}

TEST_CASE("equations (6) and (7) are the linear motion as k goes to 0, without a jump") {
  const double a = kGravity * (std::sin(0.3) - 0.1 * std::cos(0.3));
  const Kinematics uniform = uniform_motion(a, 0.1, 0.5, 2.0);
  for (const double k : {0.0, 1e-300, 1e-18, 1e-15, 1e-12, 1e-10}) {
    const Kinematics linear = linear_motion(a, k, 0.1, 0.5, 2.0);
    // To first order the distance differs by k |v0 t² / 2 + a t³ / 6| < 4 k, beside rounding of terms of 5 m.
    CHECK(std::abs(linear.x_m - uniform.x_m) < 4.0 * k + 2e-15);
    CHECK(std::abs(linear.v_m_s - uniform.v_m_s) < 8.0 * k + 2e-15);
  }
}

TEST_CASE("the closed forms fulfil their differential equations") {
  const DryTrack track = dry_track(0.075, 0.0071, 0.0071, kGravity);
  for (const double v0 : {-1.3, 0.0, 0.1, 1.2}) {
    for (const double t : {0.05, 0.3, 1.0, 3.0}) {
      const auto viscous = [&](double time) { return viscous_coulomb_motion(track, 2.768, 0.2, v0, time); };
      check_derivatives(viscous, t);
      const State at = viscous(t);
      const double expected = track.drive_m_s2 - static_cast<int>(at.mode) * track.friction_m_s2 - 2.768 * at.v_m_s;
      CHECK(std::abs(at.a_m_s2 - expected) < 1e-14);

      const auto quadratic = [&](double time) { return quadratic_coulomb_motion(track, 1.7, 0.2, v0, time); };
      check_derivatives(quadratic, t);
      const State q = quadratic(t);
      CHECK(std::abs(q.a_m_s2 - (track.drive_m_s2 - static_cast<int>(q.mode) * track.friction_m_s2 -
                                 1.7 * q.v_m_s * std::abs(q.v_m_s))) < 1e-14);
    }
  }
  for (const double n : {0.5, 0.9, 1.0, 1.5, 2.0, 3.0}) {
    const auto power = [&](double time) { return power_law_motion(1.4, n, 0.2, -1.2, time); };
    for (const double t : {0.05, 0.3, 1.0}) {
      check_derivatives(power, t);
      CHECK(std::abs(power(t).a_m_s2 - 1.4 * std::pow(-power(t).v_m_s, n)) < 1e-14);
    }
  }
}

TEST_CASE("the quadratic drag is the textbook's tangent upward and hyperbolic tangent downward") {
  const DryTrack track = dry_track(0.2, 0.0, 0.0, kGravity);
  const double a = track.drive_m_s2;
  const double q = 0.8;
  const double v_lim = std::sqrt(a / q);
  const double rate = std::sqrt(a * q);
  const double v0 = -1.5;
  const double turn_s = std::atan(-v0 / v_lim) / rate;
  REQUIRE(quadratic_coulomb_stop_time_s(track, q, v0));
  CHECK(std::abs(*quadratic_coulomb_stop_time_s(track, q, v0) - turn_s) < 1e-15);
  // Rounding of a few operations on numbers of size 1.
  CHECK(std::abs(quadratic_coulomb_motion(track, q, 0.0, v0, 0.3).v_m_s + v_lim * std::tan(rate * (turn_s - 0.3))) <
        1e-15);
  CHECK(std::abs(quadratic_coulomb_motion(track, q, 0.0, v0, 1.7).v_m_s - v_lim * std::tanh(rate * (1.7 - turn_s))) <
        1e-15);
  const double up_m = -std::log(1.0 + v0 * v0 / (v_lim * v_lim)) / (2.0 * q);
  const double down_m = std::log(std::cosh(rate * (1.7 - turn_s))) / q;
  CHECK(std::abs(quadratic_coulomb_motion(track, q, 0.0, v0, 1.7).x_m - (up_m + down_m)) < 2e-15);
  // Far beyond where cosh overflows (cosh(710)): ln cosh z = z - ln 2.
  const double late_s = 800.0 / rate;
  const State late = quadratic_coulomb_motion(track, q, 0.0, 0.0, late_s);
  CHECK(std::abs(late.x_m - (800.0 - std::log(2.0)) / q) < 1e-12);  // 1000 m: 1e-13 a rounding
}

TEST_CASE("the quadratic drag goes over into (6) and (7) as q goes to 0") {
  const DryTrack track = dry_track(0.1, 0.02, 0.02, kGravity);
  for (const double v0 : {-0.8, 0.9}) {
    const State without = viscous_coulomb_motion(track, 0.0, 0.1, v0, 1.5);
    for (const double q : {0.0, 1e-300, 1e-18, 1e-14, 1e-11}) {
      const State with = quadratic_coulomb_motion(track, q, 0.1, v0, 1.5);
      // dv <= q int v² dt < 5 q over 1.5 s at |v| < 2 m/s, and the distance 1.5 s times that; rounding of a few 1e-16.
      CHECK(std::abs(with.x_m - without.x_m) < 10.0 * q + 2e-15);
      CHECK(std::abs(with.v_m_s - without.v_m_s) < 10.0 * q + 2e-15);
    }
  }
}

TEST_CASE("a glider launched upward turns, comes down and tends to v_lim of equation (9)") {
  const DryTrack track = dry_track(0.075, 0.0071, 0.0071, kGravity);
  const double k = 2.768;
  const double up = track.drive_m_s2 + track.friction_m_s2;
  const double turn_s = std::log(1.0 + k * 1.3 / up) / k;
  REQUIRE(viscous_coulomb_stop_time_s(track, k, -1.3));
  CHECK(std::abs(*viscous_coulomb_stop_time_s(track, k, -1.3) - turn_s) < 1e-15);
  CHECK(viscous_coulomb_motion(track, k, 0.2, -1.3, turn_s * 0.999).mode == Mode::slide_up);
  const State after = viscous_coulomb_motion(track, k, 0.2, -1.3, turn_s * 1.001);
  CHECK(after.mode == Mode::slide_down);
  const State late = viscous_coulomb_motion(track, k, 0.2, -1.3, turn_s + 20.0);
  CHECK(std::abs(late.v_m_s - (track.drive_m_s2 - track.friction_m_s2) / k) < 1e-15);
}

TEST_CASE("a glider stops for good where mu is at least tan(alpha)") {
  const double incline = 0.05;
  for (const double mu : {std::tan(incline), 1.2 * std::tan(incline), 0.4}) {
    const DryTrack track = dry_track(incline, mu, mu, kGravity);
    const double stop_s = *viscous_coulomb_stop_time_s(track, 0.5, -1.0);
    const State at = viscous_coulomb_motion(track, 0.5, 0.0, -1.0, stop_s + 1.0);
    CHECK(at.mode == Mode::stick);
    CHECK(at.v_m_s == 0.0);
    CHECK(at.a_m_s2 == 0.0);
    CHECK(at.x_m == viscous_coulomb_motion(track, 0.5, 0.0, -1.0, stop_s + 7.0).x_m);
    CHECK(viscous_coulomb_motion(track, 0.5, 0.3, 0.0, 2.0).mode == Mode::stick);
  }
  const DryTrack loose = dry_track(incline, 0.999 * std::tan(incline), 0.999 * std::tan(incline), kGravity);
  CHECK(viscous_coulomb_motion(loose, 0.5, 0.0, 0.0, 2.0).mode == Mode::slide_down);
}

TEST_CASE("a power law stops in finite time below n = 1 only, and is exponential at n = 1") {
  CHECK(*power_law_stop_time_s(2.0, 0.5, -1.44) == 1.2);  // 2 sqrt(1.44) / 2
  CHECK_FALSE(power_law_stop_time_s(2.0, 1.0, -1.44));
  CHECK(power_law_motion(2.0, 0.5, 0.0, -1.44, 1.3).mode == Mode::stick);
  // distance = v0^1.5 / (1.5 k)
  CHECK(std::abs(power_law_motion(2.0, 0.5, 0.0, -1.44, 1.3).x_m + 1.728 / 3.0) < 1e-15);
  CHECK(std::abs(power_law_motion(2.0, 1.0, 0.0, 1.0, 0.7).v_m_s - std::exp(-1.4)) < 1e-15);
  for (const double off : {1e-9, -1e-9}) {
    // dv/dn = k t v ln(v)-like, of size 1: 1e-9 off in n is below 2e-9 in v and x.
    CHECK(std::abs(power_law_motion(2.0, 1.0 + off, 0.0, 1.0, 0.7).x_m - (1.0 - std::exp(-1.4)) / 2.0) < 2e-9);
    CHECK(std::abs(power_law_motion(2.0, 2.0 + off, 0.0, 1.0, 0.7).x_m - std::log(2.4) / 2.0) < 2e-9);
  }
}
