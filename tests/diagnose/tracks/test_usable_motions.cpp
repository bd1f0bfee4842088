#include "diagnose/tracks/usable_motions.h"

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <variant>

#include "base/errors.h"
#include "core/result/estimate.h"
#include "core/result/image_record.h"
#include "tests/catch.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

/// One clip of 200 positions, 10 ms apart, of a fall.
std::vector<diagnose::DoubtfulUnit> doubts_of(const std::function<double(double)>& x_m, double step_s = 0.01) {
  core::AnalysisResults results;
  results.gravity_m_s2 = 9.81;
  core::ClipResult clip;
  clip.name = "ball";
  for (int i = 0; i < 200; ++i) {
    core::MotionPoint point;
    point.t_s = step_s * i;
    point.measured_m = x_m(0.01 * i);
    clip.motion.push_back(point);
  }
  results.clips.push_back(clip);
  core::ClipSetup setup;
  setup.name = "ball";
  setup.incline_rad = 0.5 * std::numbers::pi;
  return diagnose::doubtful_units(results, {setup});
}

}  // namespace

TEST_CASE("a diagnosis doubts the units and the scale that the check doubts, and no others") {
  const auto fall = [](double g, double t) { return 0.5 * g * t * t; };
  CHECK(doubts_of([&](double t) { return fall(9.81, t); }).empty());
  const auto above = doubts_of([&](double t) { return fall(1.1 * 9.81, t); });
  REQUIRE(above.size() == 1);
  CHECK(above[0].clip == "ball");
  CHECK(std::get<core::found::FallAboveGravity>(above[0].found).acceleration_m_s2 == Approx(1.1 * 9.81).epsilon(1e-6));
  const auto far = doubts_of([](double t) { return 15.0 * t; });  // a steady fall over 30 m
  REQUIRE(far.size() == 1);
  CHECK(std::holds_alternative<core::found::LongRun>(far[0].found));
  const auto slow = doubts_of([](double t) { return t; }, 1.5);
  REQUIRE(slow.size() == 1);
  CHECK(std::holds_alternative<core::found::SlowFrames>(slow[0].found));
}

TEST_CASE("a diagnosis refuses an interlaced film, and says what to do") {
  core::AnalysisResults results;
  results.gravity_m_s2 = 9.81;
  core::ClipResult clip;
  clip.name = "up";
  clip.frame_rate_hz = 25.0;
  core::ImageRecord record;
  record.combs = 0.1;
  clip.images = std::make_shared<core::ImageRecord>(record);
  results.clips = {clip};
  core::ClipSetup setup;
  setup.file = "clips/up.mp4";
  CHECK(diagnose::doubtful_units(results, {setup}).empty());
  record.combs = 0.4;
  results.clips[0].images = std::make_shared<core::ImageRecord>(record);
  CHECK_THROWS_WITH(diagnose::doubtful_units(results, {setup}),
                    Contains("clips/up.mp4") && Contains("an interlaced film") && Contains("frame_rate_hz = 50"));
}

TEST_CASE("a diagnosis says that a stated fall begins far below gravity, as the check does") {
  core::AnalysisResults results;
  results.gravity_m_s2 = 9.81;
  core::ConfigurationResult configuration;
  configuration.incline_deg = 90.0;
  configuration.clips = {"ball", "cup"};
  core::LineFit line;
  line.direction = 1;
  line.a0_m_s2 = {2.05, 0.13};
  configuration.lines = {line};
  results.configurations = {configuration};
  const auto doubts = diagnose::doubtful_units(results, {});
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].clip == "ball");
  CHECK(std::get<core::found::FallsSlowly>(doubts[0].found).fall.a0_m_s2.value == 2.05);
  results.configurations[0].lines[0].a0_m_s2.value = 9.0;
  CHECK(diagnose::doubtful_units(results, {}).empty());
  results.configurations[0].lines[0].a0_m_s2.value = 2.05;
  results.configurations[0].incline_deg = 12.0;
  CHECK(diagnose::doubtful_units(results, {}).empty());
}

TEST_CASE("a motion that no incline gives is refused, with its clip") {
  CHECK_THROWS_AS(doubts_of([](double t) { return 0.1 * std::sin(30.0 * t); }), base::InputError);
}

namespace {

core::AnalysisResults with_clip(const core::ClipResult& clip) {
  core::AnalysisResults results;
  results.gravity_m_s2 = 9.81;
  results.clips = {clip};
  return results;
}

}  // namespace

TEST_CASE("a diagnosis refuses a recording in which nothing moves") {
  for (const double noise_m : {0.0, 1e-4}) {
    CAPTURE(noise_m);
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    try {
      doubts_of([&](double) { return 0.3 + noise_m * normal(random); });
      FAIL("a body at rest follows no law");
    } catch (const base::InputError& error) {
      REQUIRE(error.issues().size() == 1);
      CHECK(error.issues()[0].found.starts_with("nothing moves"));
    }
  }
}

TEST_CASE("a diagnosis refuses a motion opposite to its stated launch, as the check does") {
  core::ClipSetup setup;
  setup.name = "up";
  setup.track = "up.csv";
  setup.launched = core::Launched::up;
  core::ClipResult clip;
  clip.name = "up";
  clip.against_launch = core::AgainstLaunch{1, {}, 0.6, false};
  CHECK_THROWS_WITH(diagnose::doubtful_units(with_clip(clip), {setup}),
                    Contains("clip \"up\"") && Contains("opposite to launched = \"up\", 60 %") && Contains("downhill"));
  // One of several clips, or a part of a motion, as by a hand, is no reason to refuse all.
  core::AnalysisResults several = with_clip(clip);
  core::ClipResult other = clip;
  other.against_launch.reset();
  several.clips.push_back(other);
  CHECK(diagnose::doubtful_units(several, {setup, setup}).empty());
  clip.against_launch->share = 0.1;
  CHECK(diagnose::doubtful_units(with_clip(clip), {setup}).empty());
}

TEST_CASE("a diagnosis refuses positions that rise uphill, and no other contradiction") {
  core::ClipSetup setup;
  setup.name = "run";
  setup.track = "run.csv";
  core::ClipResult clip;
  clip.name = "run";
  core::AnalysisResults results = with_clip(clip);
  core::ConfigurationResult configuration;
  configuration.incline_deg = 4.0;
  configuration.clips = {"run"};
  configuration.alpha_deg = core::determined(core::estimate(-4.01, 0.015, 100.0));
  results.configurations = {configuration};
  CHECK_THROWS_WITH(diagnose::doubtful_units(results, {setup}),
                    Contains("run.csv") && Contains("positive uphill") && Contains("-4.01°, and 4.00° is stated"));
  results.configurations[0].alpha_deg = core::determined(core::estimate(2.7, 0.015, 100.0));
  CHECK(diagnose::doubtful_units(results, {setup}).empty());
}
