#include <algorithm>

#include "core/check/recording_findings.h"
#include "tests/catch.h"
#include "tests/core/findings.h"

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
