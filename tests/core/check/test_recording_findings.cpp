#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "base/files/file_io.h"
#include "core/check/check_recording.h"
#include "core/check/recording_findings.h"
#include "tests/catch.h"
#include "tests/core/findings.h"
#include "tests/core/simulated_track.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::found_as;

namespace {

/// A clip of 100 frames in which nothing is amiss.
core::ClipCheck fine_clip() {
  core::ClipCheck clip;
  clip.name = "m1-up";
  clip.images = true;
  clip.frames = clip.seen = clip.spanned = 100;
  clip.frame_rate_hz = 100.0;
  clip.marker_px = clip.marker_expected_px = 12.0;
  clip.bright_level = 0.8;
  return clip;
}

core::Experiment experiment() {
  core::Experiment experiment;
  experiment.camera.emplace().frame_rate_hz = 100.0;
  experiment.clips.resize(1);
  experiment.clips[0].name = "m1-up";
  experiment.clips[0].file = "m1-up.mkv";
  experiment.clips[0].mass_kg = 0.3;
  return experiment;
}

std::vector<core::Finding> of_clip(const core::ClipCheck& clip) {
  core::RecordingCheck check;
  check.clips = {clip};
  return core::findings_of(experiment(), check);
}

/// A good camera: nothing is amiss but perhaps the number of its views.
core::PatternCheck pattern_of(std::size_t found, std::size_t used) {
  core::PatternCheck pattern;
  pattern.covered = 0.9;
  pattern.views.resize(found);
  for (core::PatternView& view : pattern.views) view.tilt_deg = 35.0;
  pattern.calibration.emplace();
  pattern.calibration->views_used = used;
  return pattern;
}

std::vector<core::Finding> of_pattern(const core::PatternCheck& pattern) {
  core::RecordingCheck check;
  check.pattern = pattern;
  return core::findings_of(experiment(), check);
}

}  // namespace

TEST_CASE("duplicated frames above 10 % make a clip unusable, whether identical or seen as a standstill") {
  CHECK(of_clip(fine_clip()).empty());
  for (auto count : {&core::ClipCheck::repeated, &core::ClipCheck::stalls}) {
    for (const std::size_t twice : {9u, 11u}) {
      core::ClipCheck clip = fine_clip();
      clip.*count = twice;
      const auto findings = of_clip(clip);
      REQUIRE(findings.size() == 1);
      CHECK(findings[0].severity == (twice > 10 ? core::Severity::unusable : core::Severity::change));
    }
  }
}

TEST_CASE(
    "a rate of playback that is stated as filmed is said once, as a note, and half the rate may be frames dropped") {
  core::ClipCheck clip = fine_clip();
  clip.frame_rate_hz = 240.0;
  clip.container_rate_hz = 29.97;
  clip.notes = {core::ContainerOfOtherRate{29.97, 240.0, true}};  // of the analysis
  auto findings = of_clip(clip);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::note);
  CHECK(found_as<core::found::OtherRateInFile>(findings[0]).file_hz == 29.97);
  for (const auto& [file_hz, stated_hz] : {std::pair(30.0, 60.0), std::pair(120.0, 480.0), std::pair(60.0, 50.0)}) {
    clip.container_rate_hz = file_hz;
    clip.frame_rate_hz = stated_hz;
    findings = of_clip(clip);
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].severity == core::Severity::change);
  }
}

TEST_CASE("repeats that the analysis leaves out are no obstacle where the times of the others hold") {
  for (const bool in_place_of_lost : {true, false}) {
    for (const double camera_hz : {0.0, 24.0}) {
      core::ClipCheck clip = fine_clip();
      clip.stalls = 20;
      clip.seen -= 20;  // what is left out is not missing
      clip.repeats = core::RepeatsLeftOut{20, 100, in_place_of_lost, camera_hz};
      clip.notes = {*clip.repeats};
      const auto findings = of_clip(clip);
      REQUIRE(findings.size() == 1);
      const bool hold = in_place_of_lost || camera_hz > 0.0;
      CHECK(findings[0].severity == (hold ? core::Severity::change : core::Severity::unusable));
      CHECK(found_as<core::found::FramesRepeated>(findings[0]).times_hold == hold);
    }
  }
}

TEST_CASE("light is named where the marker's contrast or the place of its brightness changes along the path") {
  core::ClipCheck clip = fine_clip();
  clip.top_speed_m_s = 1.0;
  clip.top_speed_px_s = 500.0;
  clip.light = core::MarkerLighting{0.9, 0.02, 0.01};
  CHECK(of_clip(clip).empty());
  clip.light = core::MarkerLighting{0.9, 1.5, 0.4};
  auto findings = of_clip(clip);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::change);
  const auto& lit = found_as<core::found::LitFromOneSide>(findings[0]);
  CHECK(lit.changes);
  CHECK(lit.pull_px == 1.5);
  CHECK(lit.change_px == 0.4);
  CHECK(lit.px_per_m == 500.0);
  clip.light = core::MarkerLighting{0.9, 1.5, 0.1};  // the same everywhere: no position errs by more than another
  findings = of_clip(clip);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::note);
  CHECK_FALSE(found_as<core::found::LitFromOneSide>(findings[0]).changes);
  clip.light = core::MarkerLighting{0.3, 0.02, 0.01};
  findings = of_clip(clip);
  REQUIRE(findings.size() == 1);
  CHECK(found_as<core::found::ContrastFalls>(findings[0]).least == 0.3);
}

TEST_CASE("a clip whose images show a codec's blocks has too low a bit rate") {
  core::ClipCheck clip = fine_clip();
  clip.block_steps = 0.4;  // x264 by its default
  CHECK(of_clip(clip).empty());
  clip.block_steps = 0.7;
  const auto findings = of_clip(clip);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::change);
  CHECK(found_as<core::found::StrongCompression>(findings[0]).block_steps == 0.7);
  clip.frames_alone = true;  // whose errors do not last
  CHECK(of_clip(clip).empty());
  clip.block_steps = 2.5;
  CHECK(of_clip(clip).size() == 1);
}

TEST_CASE("a clip that the analysis leaves out is unusable, with its own reason alone") {
  core::ClipCheck clip = fine_clip();
  clip.block_steps = 0.7;
  clip.notes.push_back(core::NotOfStatedSize{"found two markers that look and move alike"});
  const auto findings = of_clip(clip);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::unusable);
  CHECK_THAT(found_as<core::found::NotTracked>(findings[0]).failure, Catch::Matchers::Contains("two markers"));
  clip.marker_px = 3.0 * clip.marker_expected_px;  // the stated diameter may be the cause
  CHECK(of_clip(clip).size() > 1);
}

TEST_CASE("an interlaced film is unusable as it is") {
  core::ClipCheck clip = fine_clip();
  clip.combs = 0.03;
  CHECK(of_clip(clip).empty());
  clip.combs = 0.3;
  const auto findings = of_clip(clip);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == core::Severity::unusable);
  CHECK(found_as<core::found::Interlaced>(findings[0]).frame_rate_hz == clip.frame_rate_hz);
}

TEST_CASE("an image counts as dark only if its marker is dark too, however small") {
  core::ClipCheck clip = fine_clip();
  clip.bright_level = 0.16;  // a bright marker may cover less than a thousandth of the image
  clip.marker_level = 0.8;
  clip.contrast = 0.7;
  CHECK(of_clip(clip).empty());
  clip.marker_level = 0.2;
  clip.contrast = 0.18;
  const auto findings = of_clip(clip);
  REQUIRE(findings.size() == 1);
  CHECK(found_as<core::found::Dark>(findings[0]).brightest == 0.2);
}

TEST_CASE("a camera is judged by the views that it rests on, not by those in which the pattern was found") {
  CHECK(of_pattern(pattern_of(9, 8)).empty());
  const auto findings = of_pattern(pattern_of(9, 7));
  REQUIRE(findings.size() == 1);
  CHECK(found_as<core::found::FewViews>(findings[0]).views == 7);
}

TEST_CASE("of a file on its own a check notes what is assumed, and nothing where mass and inclination are stated") {
  core::Experiment file = experiment();
  file.clips[0].launched = core::Launched::unknown;
  const auto noted = [&] { return core::findings_of(file, {}); };
  CHECK(noted().empty());
  file.clips[0].mass_assumed = true;
  REQUIRE(noted().size() == 1);
  const auto mass_alone = found_as<core::found::AssumedForFile>(noted()[0]);
  CHECK(mass_alone.mass_kg == 0.3);
  CHECK_FALSE(mass_alone.incline_deg);
  file.clips[0].incline_assumed = true;
  REQUIRE(noted().size() == 1);
  const auto both = found_as<core::found::AssumedForFile>(noted()[0]);
  CHECK(both.mass_kg == 0.3);
  CHECK(both.incline_deg == 0.0);
  file.clips[0].mass_assumed = false;
  REQUIRE(noted().size() == 1);
  CHECK_FALSE(found_as<core::found::AssumedForFile>(noted()[0]).mass_kg);
}

using namespace glidelab;
using core::Finding;
using core::LengthUnit;
using core::Severity;
using core::Subject;
using core::Topic;
using tests::found_as;

namespace {

const Subject kOne{Subject::Part::clips, {"m1"}};

core::Experiment of_one_clip(double mass_kg = 0.3) {
  core::Experiment experiment;
  experiment.clips.resize(1);
  experiment.clips[0].name = "m1";
  experiment.clips[0].mass_kg = mass_kg;
  return experiment;
}

/// A slope of 4.3 degrees whose track's x is multiplied by `per_m`, checked as a folder that states `stated_deg`.
core::RecordingCheck checked(double per_m, double stated_deg, double seconds = 1.7) {
  const tests::TempDir dir;
  core::Experiment experiment;
  tests::Filming how;
  how.duration_s = seconds;
  for (const core::Launched launched : {core::Launched::up, core::Launched::down}) {
    const double start_m_s = launched == core::Launched::up ? -0.6 : 0.3;
    const core::TrackData track = tests::film(tests::launch(tests::Law{4.3, 0.0071, 0.8}, start_m_s, 1.7), how);
    std::string csv = "t_s,x_m\n";
    for (std::size_t k = 0; k < track.t_s.size(); ++k) {
      csv += std::to_string(track.t_s[k]) + "," + std::to_string(per_m * track.x_m[k]) + "\n";
    }
    core::ClipSetup setup = tests::clip_setup(launched, stated_deg);
    setup.name += std::to_string(experiment.clips.size());
    setup.track = dir / (setup.name + ".csv");
    base::write_file(setup.track, csv);
    experiment.clips.push_back(setup);
  }
  return core::check_recording(experiment, 1);
}

bool any_about(const std::vector<Finding>& findings, Topic topic) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) { return finding.topic == topic; });
}

}  // namespace

TEST_CASE("lengths and masses of a laboratory pass, those a hundred or a thousand times as large name their unit") {
  core::Experiment experiment = of_one_clip();
  experiment.calibration.emplace().square_m = 0.04;
  experiment.marker.emplace().diameter_m = 0.02;
  experiment.track.length_m = 1.5;
  CHECK(core::unit_findings(experiment, 1.2).empty());
  struct Row {
    double square_m;
    LengthUnit unit;
  };
  for (const Row& row :
       {Row{40.0, LengthUnit::millimetres}, Row{4.0, LengthUnit::centimetres}, Row{25.0, LengthUnit::millimetres}}) {
    experiment.calibration->square_m = row.square_m;
    const std::vector<Finding> found = core::unit_findings(experiment, 1.2);
    REQUIRE(found.size() == 1);
    const auto& length = found_as<core::found::LengthInUnit>(found[0]);
    CHECK(length.key == "square_m");
    CHECK(length.value == row.square_m);
    CHECK(length.unit == row.unit);
    CHECK(found[0].about.part == Subject::Part::pattern);
    CHECK(found[0].severity == Severity::unusable);
  }
  experiment.calibration->square_m = 0.04;
  experiment.track.length_m = 150.0;
  const std::vector<Finding> track = core::unit_findings(experiment, 1.2);
  CHECK(found_as<core::found::LengthInUnit>(track.at(0)).key == "length_m");
  CHECK(found_as<core::found::LengthInUnit>(track.at(0)).unit == LengthUnit::centimetres);
  experiment.track.length_m = {};
  experiment.scale = core::ScaleSetup{0.6, 0.0};
  const std::vector<Finding> scale = core::unit_findings(experiment, 1.2);
  CHECK(found_as<core::found::ScaleInUnit>(scale.at(0)).unit == LengthUnit::millimetres);  // 600 px per metre
}

TEST_CASE("335 kg look like grams on a track, and not on a slide of forty metres") {
  const core::Experiment experiment = of_one_clip(335.0);
  const std::vector<Finding> found = core::unit_findings(experiment, 1.2);
  REQUIRE(found.size() == 1);
  CHECK(found_as<core::found::MassInGrams>(found[0]).mass_kg == 335.0);
  CHECK(core::unit_findings(experiment, 40.0).empty());
}

TEST_CASE("what follows from squares in millimetres stands below them, and nothing else does") {
  core::Experiment experiment = of_one_clip();
  experiment.calibration.emplace().square_m = 40.0;
  const std::vector<Finding> findings = core::with_root_causes(
      experiment, {},
      {{Severity::unusable, kOne, core::found::BeyondTrack{900.0, 1.5, {}}, Topic::length},
       {Severity::unusable, kOne, core::found::MotionFault{core::found::BeyondGravity{300.0, 9.8, {}}}, Topic::length},
       {Severity::unusable, kOne, core::found::InclineOff{}, Topic::incline},
       {Severity::change, kOne, core::found::MarkerSaturated{}}});
  REQUIRE(findings.size() == 2);
  CHECK(found_as<core::found::LengthInUnit>(findings[0]).key == "square_m");
  REQUIRE(findings[0].follow.size() == 3);
  CHECK(findings[0].follow[0].about.clips == kOne.clips);
  CHECK(found_as<core::found::BeyondTrack>(findings[0].follow[0]).distance_m == 900.0);
  found_as<core::found::MarkerSaturated>(findings[1]);
}

TEST_CASE("x in centimetres is named with its size in metres, and the inclination that it spoils follows") {
  const core::RecordingCheck check = checked(100.0, 4.3);
  REQUIRE_FALSE(check.findings.empty());
  CHECK_FALSE(check.usable);
  CHECK(found_as<core::found::TrackInUnit>(check.findings[0]).unit == LengthUnit::centimetres);
  CHECK_FALSE(check.findings[0].follow.empty());
  CHECK_FALSE(any_about(check.findings, Topic::incline));
  CHECK_FALSE(any_about(check.findings, Topic::length));
  CHECK(found_as<core::found::TrackInUnit>(checked(1000.0, 4.3).findings[0]).unit == LengthUnit::millimetres);
  CHECK(checked(1.0, 4.3).findings.empty());
}

TEST_CASE("a short run in millimetres is told from a long one in centimetres by the stated inclination") {
  const core::RecordingCheck check = checked(1000.0, 4.3, 0.5);
  REQUIRE_FALSE(check.findings.empty());
  const auto& track = found_as<core::found::TrackInUnit>(check.findings[0]);
  INFO(track.distance_m);
  CHECK(track.distance_m < 316.0);  // closer to a metre as centimetres: sqrt(100 * 1000) is as far from either
  CHECK(track.unit == LengthUnit::millimetres);
}

TEST_CASE("an inclination in radians is named, one that is only wrong is not") {
  const core::RecordingCheck radians = checked(1.0, 0.07505);  // 4.3 degrees
  REQUIRE_FALSE(radians.findings.empty());
  const auto& angle = found_as<core::found::InclineInRadians>(radians.findings[0]);
  CHECK(angle.stated_deg == Approx(0.07505).epsilon(1e-9));
  CHECK(angle.as_radians_deg == Approx(4.3).epsilon(1e-4));
  CHECK_FALSE(any_about(radians.findings, Topic::incline));
  const core::RecordingCheck wrong = checked(1.0, 2.0);
  CHECK(any_about(wrong.findings, Topic::incline));
}

TEST_CASE("a frame rate that makes the inclination right is the cause, and the inclination's finding follows") {
  core::Experiment experiment = of_one_clip();
  experiment.camera.emplace().frame_rate_hz = 120.0;
  core::RecordingCheck check;
  check.clips.resize(1);
  check.clips[0].name = "m1";
  check.clips[0].frame_rate_hz = 120.0;
  check.clips[0].container_rate_hz = 60.0;
  core::ConfigurationResult found;
  found.clips = {"m1"};
  found.incline_deg = 4.3;
  // Twice the rate is four times the acceleration: sin(alpha) = 4 sin(4.3°).
  found.alpha_deg = {core::Estimate{17.45, 0.01, 17.43, 17.47}, {}};
  check.configurations = {found};
  const std::vector<Finding> findings = core::with_root_causes(
      experiment, check, {{Severity::unusable, kOne, core::found::InclineOff{}, Topic::incline}});
  REQUIRE(findings.size() == 1);
  const auto& rate = found_as<core::found::WrongFrameRate>(findings[0]);
  CHECK(rate.stated_hz == 120.0);
  CHECK(rate.file_hz == 60.0);
  CHECK(findings[0].follow.size() == 1);
}

TEST_CASE("a recording in which nothing moves is unusable, and one clip at rest among others is only left out") {
  core::MotionLook rest;
  rest.positions = 200;
  rest.distance_m = 6e-4;
  rest.noise_m = rest.spread_m = 1e-4;  // white noise: both are its standard deviation
  core::MotionLook moving = rest;
  moving.distance_m = 0.6;
  moving.spread_m = 0.17;
  const auto severity = [](const std::vector<core::MotionLook>& looks) -> std::optional<Severity> {
    core::Experiment of = experiment();
    core::RecordingCheck check;
    of.clips.clear();
    for (const core::MotionLook& look : looks) {
      core::ClipCheck& clip = check.clips.emplace_back(fine_clip());
      clip.name = "m" + std::to_string(check.clips.size());
      clip.motion = look;
      core::ClipSetup& setup = of.clips.emplace_back(experiment().clips[0]);
      setup.name = clip.name;
    }
    for (const Finding& finding : core::findings_of(of, check)) {
      if (tests::fault_as<core::found::AtRest>(finding) != nullptr) return finding.severity;
    }
    return {};
  };
  CHECK(severity({rest}) == Severity::unusable);
  CHECK(severity({rest, rest}) == Severity::unusable);
  CHECK(severity({rest, moving}) == Severity::change);
  CHECK_FALSE(severity({moving}));
}

TEST_CASE("a track of few positions could be longer, and is unusable only where no fit is left") {
  const auto severity = [](std::size_t positions, double incline_deg) -> std::optional<Severity> {
    core::Experiment of = experiment();
    of.clips[0].incline_rad = incline_deg * std::acos(-1.0) / 180.0;
    core::RecordingCheck check;
    check.clips = {fine_clip()};
    check.clips[0].images = false;
    check.clips[0].seen = check.clips[0].frames = check.clips[0].spanned = positions;
    for (const Finding& finding : core::findings_of(of, check)) {
      if (std::holds_alternative<core::found::FewPositions>(finding.found)) return finding.severity;
    }
    return {};
  };
  // K, x0 and v0 of a fall, and mu and alpha on an incline, and six positions more.
  CHECK(severity(8, 90.0) == Severity::unusable);
  CHECK(severity(9, 90.0) == Severity::change);
  CHECK(severity(10, 4.0) == Severity::unusable);
  CHECK(severity(11, 4.0) == Severity::change);
  CHECK(severity(59, 4.0) == Severity::change);
  CHECK_FALSE(severity(60, 4.0));
}
