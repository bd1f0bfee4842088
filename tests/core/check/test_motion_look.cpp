#include "core/check/motion_look.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tests/catch.h"
#include "tests/core/findings.h"

using namespace glidelab;
using core::LengthUnit;
using core::found::BeyondGravity;

namespace {

constexpr double kGravity_m_s2 = 9.80665;

struct Positions {
  std::vector<double> t_s, x_m;
};

/// 2 s at 100 Hz with noise of 0.1 mm.
Positions positions(const std::function<double(double t_s)>& x_m, double noise_m = 1e-4) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal(0.0, noise_m > 0.0 ? noise_m : 1.0);
  Positions made;
  for (int i = 0; i < 200; ++i) {
    made.t_s.push_back(0.01 * i);
    made.x_m.push_back(x_m(made.t_s.back()) + (noise_m > 0.0 ? normal(random) : 0.0));
  }
  return made;
}

std::vector<core::Finding> findings(const Positions& of, double incline_deg = 4.0,
                                    const std::vector<core::MarkerSighting>& sightings = {}) {
  core::ClipSetup setup;
  setup.name = "clip";
  setup.incline_rad = incline_deg * std::acos(-1.0) / 180.0;
  return core::motion_findings(core::look_at_motion(of.t_s, of.x_m, sightings, false), setup, kGravity_m_s2);
}

/// Whether one fault of this kind is all that is found, and makes the motion unusable.
template <class Fault>
bool only(const std::vector<core::Finding>& found) {
  return found.size() == 1 && found[0].severity == core::Severity::unusable &&
         tests::fault_as<Fault>(found[0]) != nullptr;
}

/// Whether accelerations that no incline has, in this unit of x, are all that is found; and whether they are a fall's.
bool only_in(const std::vector<core::Finding>& found, core::LengthUnit unit, bool fall = false) {
  if (!only<BeyondGravity>(found)) return false;
  const auto& beyond = *tests::fault_as<BeyondGravity>(found[0]);
  return std::count(beyond.units.begin(), beyond.units.end(), unit) == 1 && beyond.fall == fall;
}

/// Up an incline and down again at 0.7 m/s².
double run(double t_s) {
  return 0.6 - 0.8 * t_s + 0.35 * t_s * t_s;
}

}  // namespace

TEST_CASE("a run along an incline and a fall are plausible") {
  CHECK(findings(positions(run)).empty());
  CHECK(findings(positions([](double t) { return 0.5 * kGravity_m_s2 * t * t; }), 90.0).empty());
}

TEST_CASE("x in centimetres or millimetres makes accelerations that no incline has") {
  CHECK(only_in(findings(positions([](double t) { return 100.0 * run(t); }, 0.01)), LengthUnit::centimetres));
  CHECK(only_in(findings(positions([](double t) { return 1000.0 * run(t); }, 0.1)), LengthUnit::millimetres));
}

TEST_CASE("where short stretches hide the acceleration in their noise the whole motion tells the unit") {
  CHECK(only_in(findings(positions([](double t) { return 100.0 * run(t); }, 0.3)), LengthUnit::centimetres));
  CHECK(findings(positions(run, 3e-3)).empty());
}

TEST_CASE("a sensor that jumps far off at the end of a fall makes no unit wrong") {
  // 26 positions of 0.5 s to a centimetre, as of a motion sensor, and one of the wall behind.
  Positions of;
  for (int i = 0; i < 26; ++i) {
    const double t = 0.02 * i;
    of.t_s.push_back(t);
    of.x_m.push_back(0.01 * std::round(100.0 * 2.0 * t * t));
  }
  CHECK(findings(of, 90.0).empty());
  of.t_s.push_back(0.54);
  of.x_m.push_back(2.8);
  CHECK(findings(of, 90.0).empty());
}

TEST_CASE("single echoes of a sensor make no unit wrong, wherever they are") {
  // One position in each tenth of the motion, and in the middle of it, is that of the wall: each parabola has one.
  for (const int first : {3, 7, 10, 16}) {
    Positions of = positions(run);
    for (std::size_t i = static_cast<std::size_t>(first); i < of.x_m.size(); i += 14) of.x_m[i] = 6.0;
    CHECK(findings(of).empty());
  }
}

TEST_CASE("positions seconds apart have their times in another unit") {
  Positions of = positions(run);
  for (double& t : of.t_s) t *= 1000.0;
  const std::vector<core::Finding> found = findings(of);
  REQUIRE(found.size() == 1);
  CHECK(found[0].severity == core::Severity::change);
  CHECK(tests::found_as<core::found::SlowFrames>(found[0]).apart_s == Approx(10.0).epsilon(1e-9));  // 1000 times 10 ms
}

TEST_CASE("a free fall on a stated slope of 4 degrees is none") {
  CHECK(only<core::found::FreeFall>(findings(positions([](double t) { return 0.5 * kGravity_m_s2 * t * t; }))));
}

TEST_CASE("a swing over many periods is an oscillation, and bounces of a cart are none") {
  CHECK(only<core::found::Oscillation>(
      findings(positions([](double t) { return 0.2 * std::sin(2.0 * std::acos(-1.0) * 3.0 * t); }))));
  // Flights of 0.25 s under 0.7 m/s², without loss: ten turns.
  CHECK(findings(positions(
                     [](double t) {
                       const double u = std::fmod(t, 0.25) - 0.125;
                       return 1.0 - 2.0 * 0.0055 + 0.35 * u * u;
                     },
                     1e-5))
            .empty());
}

TEST_CASE("a curved path in the image is not a straight track") {
  const Positions of = positions(run);
  const auto path = [&](double bend) {
    std::vector<core::MarkerSighting> sightings(of.x_m.size());
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      const double s = of.x_m[i] - 0.4;
      sightings[i].u_px = 100.0 + 1000.0 * s;
      sightings[i].v_px = 300.0 + 50.0 * s + 4000.0 * bend * s * s;  // sagitta over a length of 1000 s: bend at s of 1
    }
    return sightings;
  };
  // From 0.14 to 0.6 m: s from -0.26 to 0.2, half of the unit length, and half of its sagitta over length.
  CHECK(findings(of, 4.0, path(0.05)).empty());
  CHECK(only<core::found::CurvedPath>(findings(of, 4.0, path(0.5))));
}

TEST_CASE("positions without any noise are smoothed or integrated, and such as were rounded are not") {
  // Not run() alone: with its round numbers all positions are multiples of 5 µm.
  const std::vector<core::Finding> exact =
      findings(positions([](double t) { return run(t) + 0.01 * std::exp(-t); }, 0.0));
  REQUIRE(exact.size() == 1);
  CHECK(exact[0].severity == core::Severity::change);
  CHECK(tests::found_in<core::found::Smoothed>(exact) != nullptr);
  CHECK(findings(positions([](double t) { return 0.001 * std::round(1000.0 * run(t)); }, 0.0)).empty());
}

TEST_CASE("of a motion that a recorded force drives the size of the acceleration says nothing") {
  const Positions of = positions([](double t) { return 0.2 * std::sin(20.0 * t); });
  const core::MotionLook look = core::look_at_motion(of.t_s, of.x_m, {}, true);
  CHECK_FALSE(look.acceleration_m_s2);
  CHECK_FALSE(look.oscillates);
}

TEST_CASE("a fall whose accelerations are above gravity by chance only is a fall") {
  // Seven positions at 100 Hz with 0.8 mm of noise: a parabola's a has a standard deviation of 0.8e-3 sqrt(720/7)/0.06²
  // = 2.3 m/s², a fifth of g, and the median of the nine a few tenths of that.
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 8e-4);
    Positions of;
    for (int i = 0; i < 65; ++i) {
      const double t = 0.01 * i;
      of.t_s.push_back(t);
      of.x_m.push_back(0.5 * kGravity_m_s2 * t * t + normal(random));
    }
    CHECK(findings(of, 90.0).empty());
  }
}

TEST_CASE("gravity in feet is told as feet") {
  CHECK(only_in(findings(positions([](double t) { return 0.5 * kGravity_m_s2 / 0.3048 * t * t; }, 1e-3)),
                LengthUnit::feet, true));
}

TEST_CASE("gaps that hold much of the time are told") {
  Positions made = positions(run), clusters;
  for (std::size_t i = 0; i < made.t_s.size(); ++i) {
    if (i % 40 >= 8) continue;  // 8 positions, then 0.33 s without
    clusters.t_s.push_back(made.t_s[i]);
    clusters.x_m.push_back(made.x_m[i]);
  }
  const auto found = findings(clusters);
  const auto* const gaps = tests::found_in<core::found::Gaps>(found);
  REQUIRE(gaps != nullptr);
  CHECK(gaps->longest_s == Approx(0.33).epsilon(1e-9));
  CHECK(findings(made).empty());
}
