#include "core/check/motion_look.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <variant>
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

TEST_CASE("a fall over a long way whose acceleration is that of gravity is in metres, a steady one may not be") {
  const auto fall = [](double of_gravity) {
    return [of_gravity](double t) { return 15.0 * t + 0.5 * of_gravity * kGravity_m_s2 * t * t; };
  };
  for (const double of_gravity : {0.4, 0.93, 1.0}) {
    CAPTURE(of_gravity);
    CHECK(findings(positions(fall(of_gravity)), 90.0).empty());
  }
  for (const double of_gravity : {0.0, 0.2}) {
    CAPTURE(of_gravity);
    const std::vector<core::Finding> found = findings(positions(fall(of_gravity)), 90.0);
    REQUIRE(found.size() == 1);
    CHECK(std::holds_alternative<core::found::LongRun>(found[0].found));
  }
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

TEST_CASE("a push beyond any incline is told with its end, a launch before the first position and a fall are none") {
  // 15 m/s² for 0.12 s, then 0.7 m/s² of friction: 1.8 m/s.
  const auto pushed = [](double t) {
    const double s = t - 0.12;
    return t < 0.12 ? 7.5 * t * t : 0.108 + 1.8 * s - 0.35 * s * s;
  };
  const std::vector<core::Finding> found = findings(positions(pushed));
  const auto* const push = tests::found_in<core::found::Pushed>(found);
  REQUIRE(push != nullptr);
  CHECK(push->acceleration_m_s2 == Approx(15.0).epsilon(0.2));
  CHECK(push->until_s == Approx(0.12).margin(0.03));
  CHECK(tests::found_in<core::found::Pushed>(findings(positions(pushed), 90.0)) == nullptr);
  CHECK(findings(positions([](double t) { return 1.8 * t - 0.35 * t * t; })).empty());
  // Against a bumper at 0.6 m/s, and back within 0.05 s: 24 m/s².
  const auto bounced = [](double t) {
    const double s = t - 0.5;
    return s < 0.0 ? 0.6 * s : s < 0.05 ? 0.6 * s - 12.0 * s * s : -0.6 * (s - 0.05);
  };
  CHECK(tests::found_in<core::found::Pushed>(findings(positions(bounced))) == nullptr);
}

TEST_CASE("frame numbers in place of times, a second apart, are told") {
  Positions of = positions(run);
  for (std::size_t i = 0; i < of.t_s.size(); ++i) of.t_s[i] = static_cast<double>(i);
  CHECK(tests::found_in<core::found::SlowFrames>(findings(of)) != nullptr);
  for (double& t : of.t_s) t *= 0.5;
  CHECK(tests::found_in<core::found::SlowFrames>(findings(of)) == nullptr);
}

TEST_CASE("a count and an angle in equal steps are no positions, marks in equal steps are") {
  const auto steps_of = [](double step) {
    Positions of;
    for (int i = 0; i < 20; ++i) {
      of.t_s.push_back(std::sqrt(0.05 * i + 0.1));
      of.x_m.push_back(step * i);
    }
    return findings(of, 90.0);
  };
  CHECK(only<core::found::Counted>(steps_of(1.0)));
  CHECK(only<core::found::Counted>(steps_of(3.14159)));
  CHECK(only<core::found::Counted>(steps_of(-6.28319)));
  CHECK(only<core::found::Counted>(steps_of(-1.0)));
  for (const double step : {0.05, 1.5, 0.1}) {
    const std::vector<core::Finding> found = steps_of(step);
    CHECK(std::none_of(found.begin(), found.end(),
                       [](const core::Finding& one) { return tests::fault_as<core::found::Counted>(one) != nullptr; }));
  }
}

TEST_CASE("a tracker that jumps to and fro shows no motion, nor does a body at rest, which is one clip's matter") {
  std::mt19937_64 random(3);
  std::bernoulli_distribution other(0.5);
  CHECK(only<core::found::LostInNoise>(findings(positions([&](double) { return other(random) ? 2.0 : 0.04; }))));
  const auto rests = [](const std::vector<core::Finding>& found) {
    return found.size() == 1 && found[0].severity == core::Severity::change &&
           tests::fault_as<core::found::AtRest>(found[0]) != nullptr;
  };
  CHECK(rests(findings(positions([](double) { return 0.3; }, 1e-3))));
  CHECK(rests(findings(positions([](double) { return 0.3; }, 0.2))));
  CHECK(rests(findings(positions([&](double) { return other(random) ? 0.301 : 0.3; }, 0.0))));  // a step of rounding
  const std::vector<core::Finding> same = findings(positions([](double) { return 0.3; }, 0.0));
  REQUIRE(rests(same));
  CHECK(tests::fault_as<core::found::AtRest>(same[0])->spread_m == 0.0);  // their mean is off by a rounding
  CHECK(findings(positions(run, 0.02)).empty());
  CHECK(findings(positions([](double t) { return 2e-3 * t; }, 1e-3)).empty());  // 4 mm in two seconds
  Positions few = positions([](double) { return 0.3; }, 1e-3);
  few.t_s.resize(12);
  few.x_m.resize(12);
  CHECK(findings(few).empty());
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

TEST_CASE("a pendulum of two swings is an oscillation, and few bounces of a cart are none") {
  for (const double swings : {1.6, 2.0, 2.6}) {
    CAPTURE(swings);
    const auto found = findings(positions([=](double t) {
      return 0.1 * std::exp(-0.05 * t) * std::cos(0.4 + 2.0 * std::acos(-1.0) * swings * t / 2.0);
    }));
    CHECK(only<core::found::Oscillation>(found));
  }
  // Flights under 0.7 m/s², each lower than the one before, between contacts with a spring of 0.1 s.
  CHECK(findings(positions([](double t) {
          const double flight = 0.6, contact = 0.1, u = std::fmod(t, flight + contact);
          if (u < flight) return 0.35 * u * (flight - u);
          const double part = (u - flight) / contact;  // the same speed at both ends
          return -0.35 * flight * contact / std::acos(-1.0) * std::sin(std::acos(-1.0) * part);
        })).empty());
}

TEST_CASE("a clip that swings is noted in the results of an analysis, and a run is not") {
  core::AnalysisResults results;
  results.gravity_m_s2 = kGravity_m_s2;
  const auto add = [&](const char* name, const Positions& of) {
    core::ClipResult& clip = results.clips.emplace_back();
    clip.name = name;
    for (std::size_t i = 0; i < of.t_s.size(); ++i) {
      core::MotionPoint& point = clip.motion.emplace_back();
      point.t_s = of.t_s[i];
      point.measured_m = of.x_m[i];
    }
  };
  add("run", positions(run));
  add("swing", positions([](double t) { return 0.1 * std::cos(0.4 + 6.0 * t); }));
  core::ConfigurationResult& configuration = results.configurations.emplace_back();
  configuration.incline_deg = 4.0;
  configuration.clips = {"run", "swing"};
  core::note_no_runs(results);
  CHECK(results.clips[0].notes.empty());
  REQUIRE(results.clips[1].notes.size() == 1);
  CHECK(std::get<core::NoRun>(results.clips[1].notes[0]).found.find("this is an oscillation") != std::string::npos);
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

namespace {

/// A body that falls through air from rest: x = (v²/g) ln cosh(g t/v), v its terminal speed.
double fall_through_air(double t_s, double terminal_m_s = 1.5) {
  return terminal_m_s * terminal_m_s / kGravity_m_s2 * std::log(std::cosh(kGravity_m_s2 * t_s / terminal_m_s));
}

}  // namespace

TEST_CASE("a fall at its terminal speed in another unit is refused by what it gains at first") {
  // Most of the 2 s are at the terminal speed, so that the median acceleration is small in any unit.
  CHECK(findings(positions([](double t) { return fall_through_air(t); }, 1e-3), 90.0).empty());
  for (const auto& [scale, unit] :
       {std::pair(100.0, LengthUnit::centimetres), std::pair(1000.0, LengthUnit::millimetres)}) {
    CAPTURE(scale);
    const auto in_unit = [scale = scale](double t) { return scale * fall_through_air(t); };
    CHECK(only_in(findings(positions(in_unit, 1e-3 * scale), 90.0), unit));
    CHECK(only<BeyondGravity>(findings(positions(in_unit, 1e-3 * scale), 2.0)));
    CHECK(only_in(findings(positions([&](double t) { return -in_unit(t); }, 1e-3 * scale), 90.0), unit));
  }
  // Played four times slower as well, a free fall is 100/16 g: no unit fits, and the distance tells.
  Positions slow = positions([](double t) { return 100.0 * fall_through_air(t); }, 0.1);
  for (double& t : slow.t_s) t *= 4.0;
  CHECK(only_in(findings(slow, 90.0), LengthUnit::centimetres));
}

TEST_CASE("a push or a bumper above gravity makes no unit wrong") {
  // 5 g for 0.06 s, then a = -0.25 m/s².
  const auto pushed = [](double t) {
    const double push = 5.0 * kGravity_m_s2, s = t - 0.3, v = push * 0.06;
    if (s < 0.0) return 0.0;
    return s < 0.06 ? 0.5 * push * s * s : 0.5 * push * 0.06 * 0.06 + v * (s - 0.06) - 0.125 * (s - 0.06) * (s - 0.06);
  };
  CHECK(tests::found_in<core::found::MotionFault>(findings(positions(pushed), 0.0)) == nullptr);
  // From 2 m/s a spring turns it back within 0.1 s: up to 6 g.
  const auto bumped = [](double t) {
    const double pi = std::acos(-1.0), s = t - 1.0;
    if (s < 0.0) return 2.0 * s;
    return s < 0.1 ? 2.0 * 0.1 / pi * std::sin(pi * s / 0.1) : -2.0 * (s - 0.1);
  };
  CHECK(tests::found_in<core::found::MotionFault>(findings(positions(bumped), 0.0)) == nullptr);
  // A sensor that drifts to the wall 2.5 m away within 0.16 s, and back.
  const auto drifts = [](double t) {
    return run(t) + 1.25 * (std::tanh((t - 1.0) / 0.02) - std::tanh((t - 1.5) / 0.02));
  };
  CHECK(tests::found_in<core::found::MotionFault>(findings(positions(drifts))) == nullptr);
}

TEST_CASE("a fall up to twice gravity has a scale or a frame rate that is off") {
  for (const double scale : {1.1, 1.6}) {
    CAPTURE(scale);
    const auto found = findings(positions([&](double t) { return scale * 0.5 * kGravity_m_s2 * t * t; }, 1e-3), 90.0);
    REQUIRE(found.size() == 1);
    CHECK(found[0].severity == core::Severity::change);
    const auto& above = tests::found_as<core::found::FallAboveGravity>(found[0]);
    // The median of ten parabolas' a, each with a sd of 1e-3 sqrt(720/20)/0.19² = 0.17 m/s².
    CHECK(above.acceleration_m_s2 == Approx(scale * kGravity_m_s2).margin(0.3));
  }
  CHECK(only<BeyondGravity>(findings(positions([](double t) { return 1.1 * kGravity_m_s2 * t * t; }, 1e-3), 90.0)));
  // No incline below 60 degrees gives as much.
  CHECK(only<BeyondGravity>(findings(positions([](double t) { return 0.6 * kGravity_m_s2 * t * t; }, 1e-3), 4.0)));
}

TEST_CASE("only units are named in which the acceleration is possible") {
  const auto units = [](double a_m_s2, double incline_deg) {
    const auto found = findings(positions([&](double t) { return 0.5 * a_m_s2 * t * t; }), incline_deg);
    const auto* const fault = tests::found_in<core::found::MotionFault>(found);
    REQUIRE(fault != nullptr);
    return std::get<BeyondGravity>(*fault).units;
  };
  using Units = std::vector<LengthUnit>;
  // A fall with drag, at 0.8 g.
  CHECK(units(0.8 * kGravity_m_s2 * 100.0, 90.0) == Units{LengthUnit::centimetres});
  CHECK(units(0.8 * kGravity_m_s2 * 1000.0, 90.0) == Units{LengthUnit::millimetres});
  CHECK(units(0.8 * kGravity_m_s2 / 0.0254, 90.0) == Units{LengthUnit::inches});
  CHECK(units(0.8 * kGravity_m_s2 / 0.3048, 90.0) == Units{LengthUnit::feet});
  // 7 g on 4 degrees: 0.07 g in centimetres, of g sin 4° = 0.070 g.
  CHECK(units(7.0 * kGravity_m_s2, 4.0).front() == LengthUnit::centimetres);
  // 8 times gravity over 157 "m" is no unit alone: the distance tells.
  CHECK(units(8.0 * kGravity_m_s2, 90.0) == Units{LengthUnit::centimetres});
  Positions slow = positions([](double t) { return 100.0 * fall_through_air(t); }, 0.1);
  for (double& t : slow.t_s) t *= 6.0;  // 100/36 g at first, over 280 "m"
  const auto found = findings(slow, 90.0);
  const auto* const fault = tests::found_in<core::found::MotionFault>(found);
  REQUIRE(fault != nullptr);
  CHECK(std::get<BeyondGravity>(*fault).units == Units{LengthUnit::centimetres});
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
