#include "diagnose/tracks/coarse_force.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// A pull that changes slowly and shakes at 300 Hz, at 1 kHz for 2 s.
diagnose::TrackedMotion pulled(double shake_n) {
  diagnose::TrackedMotion motion;
  for (int i = 0; i <= 2000; ++i) {
    const double t = 1e-3 * i;
    motion.known.t_s.push_back(t);
    motion.known.force_n.push_back(3.0 * std::sin(2.0 * t) + shake_n * std::sin(2.0 * std::numbers::pi * 300.0 * t));
  }
  return motion;
}

/// The distance of a body from the middle of its path at half of the time, by steps of a tenth of the sample interval.
/// It does not change if a straight line is added.
double bend(const diagnose::KnownForce& force, double mass_kg) {
  double x = 0.0, v = 0.0, half = 0.0;
  std::size_t before = 0;
  constexpr double kStep_s = 1e-4;
  for (double t = force.t_s.front() + 0.5 * kStep_s; t < force.t_s.back(); t += kStep_s) {
    while (before + 2 < force.t_s.size() && force.t_s[before + 1] <= t) ++before;
    const double part = (t - force.t_s[before]) / (force.t_s[before + 1] - force.t_s[before]);
    const double a = (force.force_n[before] + part * (force.force_n[before + 1] - force.force_n[before])) / mass_kg;
    x += kStep_s * (v + 0.5 * kStep_s * a);
    v += kStep_s * a;
    if (t < 0.5 * force.t_s.back()) half = x;
  }
  return half - 0.5 * x;
}

}  // namespace

TEST_CASE("a force that shakes fast becomes few samples that move the body alike") {
  diagnose::TrackedMotion motion = pulled(0.5);
  const diagnose::KnownForce fine = motion.known;
  diagnose::coarsen_force(motion, 0.4, 1e-5);
  CHECK(motion.known.t_s.size() < fine.t_s.size() / 2 + 2);
  CHECK(motion.known.t_s.front() == fine.t_s.front());
  CHECK(motion.known.t_s.back() == fine.t_s.back());
  CHECK(std::is_sorted(motion.known.t_s.begin(), motion.known.t_s.end()));
  CHECK(std::abs(bend(motion.known, 0.4) - bend(fine, 0.4)) < 2e-5);  // 0.6 m
}

TEST_CASE("a force of which every sample counts stays as it is") {
  diagnose::TrackedMotion motion = pulled(0.5);
  const diagnose::KnownForce fine = motion.known;
  diagnose::coarsen_force(motion, 0.4, 1e-12);
  CHECK(motion.known.t_s == fine.t_s);
  CHECK(motion.known.force_n == fine.force_n);
}

TEST_CASE("means of a force keep straight lines") {
  diagnose::TrackedMotion motion;
  for (int i = 0; i <= 500; ++i) {
    motion.known.t_s.push_back(1e-3 * i);
    motion.known.force_n.push_back(2.0 - 3.0 * 1e-3 * i);
  }
  diagnose::coarsen_force(motion, 1.0, 1e-9);
  REQUIRE(motion.known.t_s.size() < 50);
  for (std::size_t i = 0; i < motion.known.t_s.size(); ++i) {
    CHECK(motion.known.force_n[i] == Approx(2.0 - 3.0 * motion.known.t_s[i]).epsilon(1e-12));
  }
}
