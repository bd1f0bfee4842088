#include "core/check/statement_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/files/file_io.h"
#include "core/check/check_recording.h"
#include "core/result/estimate.h"
#include "tests/catch.h"
#include "tests/core/findings.h"
#include "tests/core/simulated_track.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using core::Launched;
using tests::found_as;

namespace {

const tests::Law kSlope{4.3, 0.0071, 0.8};

double angle_deg(double sine) {
  return std::asin(sine) * 180.0 / std::numbers::pi;
}

/// A folder with one track for each launch on the slope of 4.3 degrees, whose lengths are `scale` times the true ones.
struct Recorded {
  tests::TempDir dir;
  core::Experiment experiment;
  explicit Recorded(const std::vector<Launched>& launches, double stated_deg = 4.3, double scale = 1.0) {
    for (const Launched launched : launches) {
      const double start_m_s = launched == Launched::up ? -0.6 : 0.3;
      const core::TrackData track = tests::film(tests::launch(kSlope, start_m_s, 1.7), {});
      std::string csv = "t_s,x_m\n";
      for (std::size_t k = 0; k < track.t_s.size(); ++k) {
        csv += std::to_string(track.t_s[k]) + "," + std::to_string(scale * track.x_m[k]) + "\n";
      }
      core::ClipSetup setup = tests::clip_setup(launched, stated_deg);
      setup.name += std::to_string(experiment.clips.size());
      setup.track = dir / (setup.name + ".csv");
      base::write_file(setup.track, csv);
      experiment.clips.push_back(setup);
    }
  }
  std::vector<core::Finding> findings() const { return core::check_recording(experiment, 1).findings; }
};

const std::vector<Launched> kBoth = {Launched::up, Launched::down};

const core::InclineContradiction& contradiction_of(const core::Finding& finding) {
  return found_as<core::found::InclineOff>(finding).contradiction;
}

/// The inclination that the motion makes.
double found_deg(const core::Finding& finding) {
  return contradiction_of(finding).deg;
}

core::ClipCheck sized(const std::string& name, double marker_px, double expected_px) {
  core::ClipCheck clip;
  clip.name = name;
  clip.marker_px = marker_px;
  clip.marker_expected_px = expected_px;
  clip.blur_px = 0.5;
  return clip;
}

std::vector<core::Finding> of_sizes(const std::vector<core::ClipCheck>& clips) {
  core::Experiment experiment;
  experiment.calibration.emplace();
  experiment.clips.resize(clips.size());
  for (core::ClipSetup& clip : experiment.clips) clip.mass_kg = 0.3;
  core::RecordingCheck check;
  check.clips = clips;
  return core::statement_findings(experiment, check);
}

}  // namespace

TEST_CASE("an inclination, lengths and gravity that agree with the motion are no finding") {
  CHECK(Recorded(kBoth).findings().empty());
  CHECK(Recorded({Launched::up}).findings().empty());
  CHECK(Recorded({Launched::down}).findings().empty());
  Recorded loose(kBoth, 2.5);  // 1.8 degrees off
  for (core::ClipSetup& clip : loose.experiment.clips) clip.incline_sd_rad = 0.8 / 57.3;
  CHECK(loose.findings().empty());
}

TEST_CASE("lengths or a gravity 60 % off make the recording unusable, said once with the angle that they lead to") {
  const double sine = std::sin(kSlope.alpha_deg * std::numbers::pi / 180.0);
  const auto long_metres = Recorded({Launched::up, Launched::down, Launched::up, Launched::down}, 4.3, 1.6).findings();
  REQUIRE(long_metres.size() == 1);
  CHECK(long_metres[0].severity == core::Severity::unusable);
  CHECK(std::abs(found_deg(long_metres[0]) - angle_deg(1.6 * sine)) < 0.05);
  CHECK(contradiction_of(long_metres[0]).stated.by == "incline_deg");
  CHECK(contradiction_of(long_metres[0]).stated.deg == Approx(4.3).epsilon(1e-9));
  CHECK(found_as<core::found::InclineOff>(long_metres[0]).lengths.tracks);
  Recorded heavy(kBoth);
  heavy.experiment.gravity_m_s2 *= 1.6;
  const auto gravity = heavy.findings();
  REQUIRE(gravity.size() == 1);
  CHECK(gravity[0].severity == core::Severity::unusable);
  CHECK(std::abs(found_deg(gravity[0]) - angle_deg(sine / 1.6)) < 0.05);
  CHECK(contradiction_of(gravity[0]).gravity_m_s2 == Approx(1.6 * tests::kGravity).epsilon(1e-9));
}

TEST_CASE("an acceleration that no inclination has is told as that, and a track in millimetres has one") {
  const auto findings = Recorded(kBoth, 4.3, 1000.0).findings();
  REQUIRE_FALSE(findings.empty());
  CHECK(findings[0].severity == core::Severity::unusable);
  CHECK(found_as<core::found::TrackInUnit>(findings[0]).unit == core::LengthUnit::millimetres);
  CHECK(found_as<core::found::TrackInUnit>(findings[0]).distance_m == Approx(920.0).margin(5.0));
  CHECK(std::any_of(findings[0].follow.begin(), findings[0].follow.end(), [](const core::Finding& finding) {
    return finding.topic == core::Topic::incline && contradiction_of(finding).beyond_gravity > tests::kGravity;
  }));
}

TEST_CASE("motion in one direction bounds the inclination by friction, and contradicts it on one side only") {
  const auto at_most = Recorded({Launched::up, Launched::up}, 10.0);  // they turn, and come back
  CHECK(at_most.findings().size() == 1);
  core::ConfigurationResult one_way;
  one_way.incline_deg = 4.3;
  core::LineFit line;
  line.direction = -1;
  line.a0_m_s2 = {kSlope.a0(-1), 0.001, 0.0, 0.0};
  one_way.lines = {line};
  const auto against = [&](double stated_deg) {
    return core::incline_contradiction(one_way, tests::kGravity, {stated_deg, {}, "incline_deg"});
  };
  CHECK_FALSE(against(-30.0).has_value());
  REQUIRE(against(10.0).has_value());
  CHECK(against(10.0)->bound == -1);
  CHECK(std::abs(against(10.0)->off_deg - (10.0 - angle_deg(kSlope.a0(-1) / tests::kGravity))) < 1e-9);
  one_way.lines[0].direction = 1;
  CHECK_FALSE(against(10.0).has_value());
  REQUIRE(against(-30.0).has_value());
  CHECK(against(-30.0)->bound == 1);
}

TEST_CASE("a track off by less than a degree is advice, by less than half a degree none") {
  CHECK(Recorded(kBoth, 4.7).findings().empty());
  const auto findings = Recorded(kBoth, 5.1).findings();
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::change);
}

TEST_CASE("an inclination stated with its uncertainty is contradicted by three standard deviations, however small") {
  const auto at = [](double stated_deg, double sd_deg) {
    Recorded recorded(kBoth, stated_deg);
    for (core::ClipSetup& clip : recorded.experiment.clips) clip.incline_sd_rad = sd_deg * std::numbers::pi / 180.0;
    return recorded.findings();
  };
  CHECK(at(4.5, 0.1).empty());  // 0.2 degrees off: two standard deviations
  const auto findings = at(4.5, 0.02);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::change);
  CHECK_FALSE(contradiction_of(findings[0]).gross);
  core::ConfigurationResult result;  // as an analysis notes it
  result.mass_kg = 0.3;
  result.incline_deg = 5.0;
  result.alpha_deg = core::determined({5.2, 0.004, 5.192, 5.208});
  std::vector<core::ConfigurationResult> results{result};
  core::note_statements(results, {}, tests::kGravity);
  CHECK(results[0].notes.empty());
  results[0].incline_sd_deg = 0.02;
  core::note_statements(results, {}, tests::kGravity);
  REQUIRE(results[0].notes.size() == 1);
  CHECK(std::holds_alternative<core::InclineContradiction>(results[0].notes[0]));
}

TEST_CASE("light from one side explains a marker that looks too small, but not one that looks too large") {
  const auto lit = [](double marker_px) {
    core::ClipCheck clip = sized("a", marker_px, 19.0);
    clip.light = core::MarkerLighting{0.9, 2.3, 0.1};
    return of_sizes({clip});
  };
  CHECK(lit(13.2).empty());
  CHECK(lit(26.0).size() == 1);
  CHECK(lit(9.0).size() == 1);  // less than half of it is lit: from behind
}

TEST_CASE("a glider that runs farther than the track is long is a finding") {
  Recorded recorded(kBoth);
  recorded.experiment.track.length_m = 2.0;
  CHECK(recorded.findings().empty());
  recorded.experiment.track.length_m = 0.5;
  const auto findings = recorded.findings();
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::unusable);
  CHECK(found_as<core::found::BeyondTrack>(findings[0]).length_m == 0.5);
}

TEST_CASE("a marker of another size than stated is one finding for all clips, and unusable above 30 %") {
  CHECK(of_sizes({sized("a", 10.0, 11.0), sized("b", 10.0, 9.0)}).empty());
  const auto some = of_sizes({sized("a", 10.0, 12.0), sized("b", 10.0, 12.0)});
  REQUIRE(some.size() == 1);
  CHECK(some[0].severity == core::Severity::change);
  CHECK(some[0].about.clips == std::vector<std::string>{"a", "b"});
  const auto much = of_sizes({sized("a", 10.0, 16.0), sized("b", 10.0, 15.9), sized("c", 10.0, 10.0)});
  REQUIRE(much.size() == 1);
  CHECK(much[0].severity == core::Severity::unusable);
  CHECK(much[0].about.clips == std::vector<std::string>{"a", "b"});
  const auto& size = found_as<core::found::MarkerSizeOff>(much[0]);
  CHECK(size.off == Approx(0.6).epsilon(1e-9));
  CHECK_FALSE(size.by_scale);
  core::ClipCheck smeared = sized("a", 16.0, 10.0);
  smeared.blur_px = 12.0;  // its outline is the smear's
  CHECK(of_sizes({smeared}).empty());
  smeared.marker_px = 24.0;  // and more
  REQUIRE(of_sizes({smeared}).size() == 1);
  smeared.blur_px = 13.0;
  smeared.marker_px = 6.0;  // no smear makes it smaller
  REQUIRE(of_sizes({smeared}).size() == 1);
}

TEST_CASE("the size of a saturated marker, and of one that is no disc, is no measure of the scale to 15 %") {
  // A square of 10 px has the area of a disc of 11.3 px, and its corners lie 14.1 px apart.
  core::ClipCheck square = sized("a", 14.1, 10.0);
  CHECK_FALSE(of_sizes({square}).empty());
  square.notes.push_back(core::MarkerMeasuredBy{core::MarkerMeasuredBy::What::centroid});
  CHECK(of_sizes({square}).empty());
  core::ClipCheck lamp = sized("a", 4.8, 6.24);
  lamp.marker_level = 1.0;
  CHECK(of_sizes({lamp}).empty());
  lamp.marker_level = 0.8;
  REQUIRE(of_sizes({lamp}).size() == 1);
  // Lengths in the wrong unit are still found.
  square.marker_px = 100.0;
  REQUIRE(of_sizes({square}).size() == 1);
  CHECK(of_sizes({square})[0].severity == core::Severity::unusable);
}

TEST_CASE("a fall in slow motion is found by the acceleration with which it begins") {
  // From rest with viscous drag, K/m = 2/s: x = v_t (t - (1 - exp(-2 t))/2), v_t = g/2. Times four times too long.
  const tests::TempDir dir;
  for (const double slower : {1.0, 4.0}) {
    std::string csv = "t_s,x_m\n";
    for (int i = 0; i < 100; ++i) {
      const double t = 0.01 * i;
      const double noise = 5e-5 * std::sin(3.7 * i * i);
      csv += fmt::format("{:.6f},{:.7f}\n", slower * t,
                         0.5 * tests::kGravity * (t - 0.5 * (1.0 - std::exp(-2.0 * t))) + noise);
    }
    core::Experiment experiment;
    core::ClipSetup setup = tests::clip_setup(Launched::unknown, 90.0);
    setup.track = dir / fmt::format("{}.csv", slower);
    base::write_file(setup.track, csv);
    experiment.clips = {setup};
    const std::vector<core::Finding> findings = core::check_recording(experiment, 1).findings;
    const auto* const slow = tests::found_in<core::found::FallsSlowly>(findings);
    CAPTURE(slower);
    REQUIRE((slow != nullptr) == (slower > 1.0));
    if (slow != nullptr) CHECK(slow->fall.a0_m_s2.value == Approx(tests::kGravity / 16.0).epsilon(0.05));
  }
}

TEST_CASE("a large mass looks like grams unless what moves runs as far as a sledge or a car") {
  core::ConfigurationResult result;
  result.mass_kg = 80.0;
  result.clips = {"run"};
  result.incline_assumed = true;
  const auto notes_at = [&](const core::ClipResult& clip) {
    std::vector<core::ConfigurationResult> results{result};
    core::note_statements(results, {clip}, tests::kGravity);
    return results[0].notes.size();
  };
  core::ClipResult of_positions, of_speeds;
  of_speeds.speed_noise_m_s = 0.1;
  of_positions.name = of_speeds.name = "run";
  for (int i = 0; i <= 10; ++i) {
    core::MotionPoint point;
    point.t_s = i;
    point.v_m_s = 3.0;
    of_speeds.motion.push_back(point);
    point.measured_m = 3.0 * i;
    of_positions.motion.push_back(point);
  }
  CHECK(notes_at(of_positions) == 0);  // 30 m
  CHECK(notes_at(of_speeds) == 0);
  of_positions.motion.resize(6);  // 15 m
  of_speeds.motion.resize(6);
  CHECK(notes_at(of_positions) == 1);
  CHECK(notes_at(of_speeds) == 1);
}
