#include "diagnose/tracks/rounded_positions.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "core/math/even_times.h"
#include "core/motion/smoothing/noise.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kStep_m = 0.01;

/// An ideal cart, up an incline and down again, as a motion sensor exports it: 50 Hz, whole centimetres. The phase of
/// the start in the step goes by the seed.
tests::MadeExperiment exported(unsigned seed) {
  std::vector<tests::MadeLaunch> launches;
  for (int clip = 0; clip < 6; ++clip) {
    const double phase = std::fmod(0.6180339887 * (7 * seed + clip), 1.0) * kStep_m;
    launches.push_back({clip % 2 == 0 ? 0.3 : 0.5, 3.0, 1.5 + phase, -1.2 - 0.05 * clip});
  }
  tests::MadeEffect rounded;
  rounded.seen = [](double x, double) { return kStep_m * std::round(x / kStep_m); };
  return tests::made_experiment(launches, rounded, seed, 0.0, 200, 50.0, 0.1, 0.0, {.k_n_s_m = 0.02, .mu = 0.005});
}

}  // namespace

TEST_CASE("the step of rounded positions is found, also where no two neighbours lie a single step apart") {
  std::vector<double> slow, fast, fine;
  for (int i = 0; i < 40; ++i) {
    slow.push_back(kStep_m * std::round(0.1 * i * i));
    fast.push_back(kStep_m * (5.0 * i + i % 3));  // changes of 3 and 6 steps: their largest common part
    fast.back() += i % 4 == 0 ? kStep_m : 0.0;
    fine.push_back(0.0123 * std::sin(0.3 * i));
  }
  CHECK(core::rounding_step(slow) == Approx(kStep_m).epsilon(1e-9));
  CHECK(core::rounding_step(fast) == Approx(kStep_m).epsilon(1e-9));
  CHECK(core::rounding_step(fine) == 0.0);
}

TEST_CASE("frames err alike where the motion is slow or passes whole steps, and not between") {
  // Positions that move on by so many steps a frame, evenly.
  const auto alike = [](double steps) {
    std::vector<double> t, x;
    for (int i = 0; i < 60; ++i) {
      t.push_back(0.02 * i);
      x.push_back(kStep_m * std::round(steps * i + 0.31));
    }
    return diagnose::frames_alike(t, x, kStep_m)[30];
  };
  // The shift is 0.2 of a step after 0.2/0.05 = 4 frames either way; the slope errs by up to 0.03 steps.
  CHECK(alike(0.05) >= 4.0);
  CHECK(alike(0.05) <= 21.0);
  CHECK(alike(3.05) >= 4.0);
  CHECK(alike(3.05) <= 21.0);
  CHECK(alike(0.45) == 1.0);
  CHECK(alike(2.37) == 1.0);
  CHECK(alike(0.0) == 60.0);  // at rest
}

TEST_CASE("the noise of rounded positions is no less than what rounding makes, and wider about the turn") {
  const tests::MadeExperiment made = exported(1);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(set.motions.size() == 6);
  CHECK(diagnose::noise_is_rounding(set));
  for (const diagnose::TrackedMotion& motion : set.motions) {
    CHECK(motion.step_m == Approx(kStep_m).epsilon(1e-9));
    CHECK(motion.sd_m >= kStep_m / std::sqrt(12.0) * (1.0 - 1e-9));
    const auto top = std::min_element(motion.x_m.begin(), motion.x_m.end()) - motion.x_m.begin();
    CHECK(motion.wider[static_cast<std::size_t>(top)] > 1.5);
    CHECK(motion.wider.front() < 2.0);
  }
}

TEST_CASE("an ideal cart whose positions are rounded to a centimetre has no effect") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    CAPTURE(seed);
    const tests::MadeExperiment made = exported(seed);
    const diagnose::Diagnosis diagnosis =
        diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
    CHECK(diagnosis.traces == std::vector<std::string>{"position_rounding"});
  }
}

TEST_CASE("an ideal motion that is written with six digits lacks nothing: a step of the times is no cause") {
  constexpr double kDigit = 1e-6;
  for (const unsigned clips : {1u, 2u, 4u}) {
    CAPTURE(clips);
    std::vector<tests::MadeLaunch> launches;
    for (unsigned clip = 0; clip < clips; ++clip) launches.push_back({0.3 + 0.1 * clip, 2.0, 0.1, 0.05 * clip});
    tests::MadeEffect written;
    written.seen = [](double x, double) { return kDigit * std::round(x / kDigit); };
    tests::MadeExperiment made =
        tests::made_experiment(launches, written, 1, 0.0, 120, 60.0, 0.1, 0.0, {.k_n_s_m = 1e-4, .mu = 1e-3});
    for (core::ClipResult& clip : made.results.clips) {
      std::vector<double> t_s;
      for (const core::MotionPoint& point : clip.motion) t_s.push_back(kDigit * std::round(point.t_s / kDigit));
      const std::optional<core::EvenTimes> even = core::even_times(t_s, core::StampSource::table);  // as a file is read
      REQUIRE(even);
      for (std::size_t i = 0; i < t_s.size(); ++i) clip.motion[i].t_s = even->t_s[i];
    }
    const diagnose::Diagnosis diagnosis =
        diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
  }
}

namespace {

/// Four digits below 0.1 and three decimals above, as Tracker writes numbers by default.
double as_tracker_writes(double x) {
  if (std::abs(x) >= 0.1 || x == 0.0) return std::round(1e3 * x) / 1e3;
  const double digit = std::pow(10.0, std::floor(std::log10(std::abs(x))) - 3.0);
  return digit * std::round(x / digit);
}

/// An ideal cart at 60 Hz that starts before the origin, whose positions are noisy and then written.
tests::MadeExperiment written_by_tracker(unsigned seed) {
  auto random = std::make_shared<std::mt19937>(seed);
  tests::MadeEffect written;
  written.seen = [random](double x, double) {
    std::normal_distribution<double> noise(0.0, 6e-5);
    return as_tracker_writes(x + noise(*random));
  };
  const std::vector<tests::MadeLaunch> launches = {{0.3, 3.0, -0.09, 0.02}};
  return tests::made_experiment(launches, written, seed, 0.0, 110, 60.0, 0.1, 0.0, {.k_n_s_m = 0.02, .mu = 0.002});
}

}  // namespace

TEST_CASE("positions written more coarsely beyond 0.1 m have the noise of the coarse digits") {
  const tests::MadeExperiment made = written_by_tracker(1);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(set.motions.size() == 1);
  CHECK(diagnose::noise_is_rounding(set));
  CHECK(set.motions[0].step_m == Approx(1e-3).epsilon(1e-9));
  CHECK(set.motions[0].sd_m >= 1e-3 / std::sqrt(12.0) * (1.0 - 1e-9));
}

TEST_CASE("if few positions are written more coarsely, they alone have that noise") {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 6e-5);
  diagnose::TrackedMotion motion;
  for (int i = 0; i < 200; ++i) {
    motion.t_s.push_back(0.01 * i);
    motion.x_m.push_back(as_tracker_writes(0.011 + 0.00048 * i + noise(random)));
  }
  motion.outlier.resize(motion.x_m.size(), 0);
  motion.sd_m = 1e-4;
  diagnose::add_rounding(motion);
  CHECK(motion.step_m == 0.0);
  CHECK(motion.sd_m == Approx(6e-5).epsilon(0.2));  // 2 sd of that of 180 correlated differences
  for (std::size_t p = 0; p < motion.x_m.size(); ++p) {
    const bool coarse = motion.x_m[p] > 0.0999999;
    const double own_m = coarse ? std::hypot(motion.sd_m, 1e-3 / std::sqrt(12.0)) : motion.sd_m;
    CHECK(motion.own_sd_of(p) == Approx(own_m).epsilon(1e-2));
    CHECK(motion.sd_of(p) >= motion.own_sd_of(p) * (1.0 - 1e-12));
  }
}

TEST_CASE("an ideal cart in Tracker's default number format lacks nothing") {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    CAPTURE(seed);
    const tests::MadeExperiment made = written_by_tracker(seed);
    const diagnose::Diagnosis diagnosis =
        diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
    CHECK(diagnosis.traces == std::vector<std::string>{"position_rounding"});
  }
}
