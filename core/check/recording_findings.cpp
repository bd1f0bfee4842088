#include "core/check/recording_findings.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "base/math/angles.h"
#include "core/check/motion_look.h"
#include "core/check/recording_check.h"
#include "core/check/root_causes.h"
#include "core/check/statement_findings.h"
#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {
namespace {

// docs/reference/check.md gives the reason for each limit.
constexpr std::size_t kFewViews = 8;
constexpr double kMostPatternRmsPx = 0.3, kUnusablePatternRmsPx = 1.0;  // rms of the camera's fit, per corner
constexpr double kLeastPlaneRmsPx = 0.05, kMostPlaneOverNoise = 3.0, kUnusablePlaneRmsPx = 1.0;
constexpr double kLeastCovered = 0.5;  // of the image's parts
constexpr double kLeastTiltDeg = 20.0;

void judge_pattern(const PatternCheck& pattern, FindingBook book) {
  if (!pattern.failure.empty()) {
    const std::size_t images = pattern.views.size() + pattern.without.size();
    book.add(Severity::unusable, found::NoCamera{pattern.failure, pattern.views.size(), images});
    return;
  }
  if (!pattern.without.empty()) book.add(Severity::change, found::NoPatternIn{pattern.without});
  if (!pattern.calibration) return;
  const CalibrationResult& camera = *pattern.calibration;
  if (camera.views_used < kFewViews) book.add(Severity::change, found::FewViews{camera.views_used});
  if (camera.rms_px > kMostPatternRmsPx) {
    book.add(camera.rms_px > kUnusablePatternRmsPx ? Severity::unusable : Severity::change,
             found::CornersOff{camera.rms_px});
  }
  if (pattern.covered < kLeastCovered) book.add(Severity::change, found::LittleCovered{pattern.covered});
  double tilt_deg = 0.0;
  for (const PatternView& view : pattern.views) tilt_deg = std::max(tilt_deg, view.tilt_deg);
  if (tilt_deg < kLeastTiltDeg) book.add(Severity::change, found::LittleTilt{tilt_deg});
  if (camera.plane_rms_px > std::max(kLeastPlaneRmsPx, kMostPlaneOverNoise * camera.plane_expected_px)) {
    book.add(camera.plane_rms_px > kUnusablePlaneRmsPx ? Severity::unusable : Severity::change,
             found::PlaneViewsOff{camera.plane_rms_px, camera.plane_expected_px});
  }
  for (const Note& note : camera.notes) {
    if (!std::holds_alternative<NoPatternInSight>(note)) book.add(Severity::note, note);  // reported above, with advice
  }
}

// Of clips.

constexpr std::size_t kUnusableSightings = 20, kFewSightings = 60;
constexpr double kLeastSeenShare = 0.95, kUnusableSeenShare = 2.0 / 3.0;
constexpr std::size_t kMostUnseenAtEnd = 3;  // frames at a clip's start or end
constexpr double kLeastPathInside = 0.95;    // of the marker's path
constexpr double kSmallMarkerPx = 6.0, kUnusableMarkerPx = 3.0;
constexpr double kLeastContrast = 0.15, kLeastSignalToNoise = 20.0, kUnusableSignalToNoise = 5.0;
constexpr double kMostPullChange_px = 0.15;  // ten times the part due to a centroid's noise
constexpr double kLargePull = 0.05;          // of the marker's diameter
constexpr double kLeastContrastAlong = 0.5;  // of the largest along the path
constexpr double kSaturatedLevel = 0.985, kLeastBrightLevel = 0.25, kMostSaturatedShare = 0.05;
constexpr double kMostBlur = 0.5, kUnusableBlur = 2.0;                        // marker diameters
constexpr double kUnusableMissingShare = 0.01, kUnusableRepeatedShare = 0.1;  // shares of the frames
constexpr double kMostDriftFrames = 0.75;                                     // frames

void judge_times(const Experiment& experiment, const ClipCheck& clip, FindingBook& book) {
  const auto frames = static_cast<double>(std::max<std::size_t>(clip.frames, 1));
  const bool by_rate = experiment.camera->time == TimeSource::rate;
  if (clip.container_rate_hz && std::abs(*clip.container_rate_hz / clip.frame_rate_hz - 1.0) > kRateRounding) {
    book.add(by_rate ? Severity::change : Severity::note,
             found::OtherRateInFile{*clip.container_rate_hz, clip.frame_rate_hz, by_rate}, Topic::time);
  }
  if (clip.drift_frames > kMostDriftFrames) {
    book.add(by_rate ? Severity::unusable : Severity::note,
             found::UnevenStamps{clip.drift_frames, clip.irregular_steps, by_rate});
  }
  if (clip.jumps > 0 && by_rate) {
    const double share = static_cast<double>(clip.jumps) / static_cast<double>(std::max<std::size_t>(clip.seen, 1));
    book.add(share > kUnusableMissingShare ? Severity::unusable : Severity::change, found::Jumps{clip.jumps});
  }
  if (clip.repeated + clip.stalls > 0) {
    const double share = static_cast<double>(std::max(clip.repeated, clip.stalls)) / frames;
    book.add(share > kUnusableRepeatedShare ? Severity::unusable : Severity::change,
             found::FramesRepeated{clip.repeated, clip.frames, clip.stalls});
  }
}

void judge_light(const ClipCheck& clip, FindingBook& book) {
  if (clip.marker_level && *clip.marker_level > kSaturatedLevel) {
    book.add(Severity::change, found::MarkerSaturated{});
  }
  if (clip.saturated > kMostSaturatedShare) book.add(Severity::change, found::PixelsSaturated{clip.saturated});
  if (clip.bright_level < kLeastBrightLevel) book.add(Severity::change, found::Dark{clip.bright_level});
  if (clip.contrast && *clip.contrast < kLeastContrast) {
    book.add(Severity::change, found::LittleContrast{*clip.contrast});
  }
  if (clip.contrast && *clip.contrast < kLeastSignalToNoise * clip.pixel_noise) {
    const double signal = *clip.contrast / clip.pixel_noise;
    book.add(signal < kUnusableSignalToNoise ? Severity::unusable : Severity::change, found::NoisyContrast{signal});
  }
}

/// Light that varies with position, and its effect on the marker's apparent centre.
void judge_lighting(const ClipCheck& clip, FindingBook& book) {
  if (!clip.light) return;
  found::LitFromOneSide side{clip.light->pull_px, clip.light->pull_change_px, {}, false};
  if (clip.top_speed_m_s > 0.0 && clip.top_speed_px_s > 0.0) side.px_per_m = clip.top_speed_px_s / clip.top_speed_m_s;
  side.changes = side.change_px > kMostPullChange_px;
  if (side.changes || side.pull_px > kLargePull * clip.marker_px) {
    book.add(side.changes ? Severity::change : Severity::note, side);
  }
  if (clip.light->least_contrast < kLeastContrastAlong) {
    book.add(Severity::change, found::ContrastFalls{clip.light->least_contrast});
  }
}

/// A marker that is smeared away where the glider is fastest is missing at a clip's start or end.
void judge_ends(const ClipCheck& clip, FindingBook& book) {
  const auto judge = [&](std::size_t unseen, const found::UnseenAtEnd& end) {
    if (unseen <= kMostUnseenAtEnd) return;
    const double share = static_cast<double>(unseen) / static_cast<double>(clip.frames);
    book.add(end.at_edge                        ? Severity::note
             : share > 1.0 - kUnusableSeenShare ? Severity::unusable
                                                : Severity::change,
             end);
  };
  const std::size_t last = clip.first + clip.spanned;
  judge(clip.first, {true, clip.first + 1, clip.frames, clip.entered});
  judge(clip.frames - last, {false, last, clip.frames, clip.left});
}

void judge_marker(const ClipCheck& clip, FindingBook& book) {
  const double share = static_cast<double>(clip.seen) / static_cast<double>(std::max<std::size_t>(clip.spanned, 1));
  if (clip.seen < kFewSightings) {
    book.add(clip.seen < kUnusableSightings ? Severity::unusable : Severity::change, found::FewSightings{clip.seen});
  }
  if (share < kLeastSeenShare) {
    book.add(share < kUnusableSeenShare ? Severity::unusable : Severity::change,
             found::SightingsMissing{clip.seen, clip.spanned});
  }
  judge_ends(clip, book);
  if (clip.marker_px < kSmallMarkerPx) {
    book.add(clip.marker_px < kUnusableMarkerPx ? Severity::unusable : Severity::change,
             found::SmallMarker{clip.marker_px});
  }
  if (clip.measured_exposure_s) {
    book.add(Severity::change, found::LongExposure{*clip.measured_exposure_s, clip.blur_px.has_value()});
  }
  const double blur_px = likely_blur_px(clip);
  if (blur_px > kMostBlur * clip.marker_px) {
    const bool known = clip.blur_px.has_value() || clip.measured_blur_px.has_value();
    book.add(known && blur_px > kUnusableBlur * clip.marker_px ? Severity::unusable : Severity::change,
             found::Smeared{clip.top_speed_m_s, blur_px, clip.marker_px, known});
  }
  if (clip.inside_pattern < kLeastPathInside) {
    book.add(Severity::change, found::OutsidePattern{1.0 - clip.inside_pattern});
  }
}

void judge_clip(const Experiment& experiment, const ClipCheck& clip, FindingBook book) {
  if (!clip.failure.empty()) {
    book.add(Severity::unusable, found::NotTracked{clip.failure, clip.images}, Topic::failure);
    return;
  }
  if (clip.images) {
    judge_marker(clip, book);
    judge_light(clip, book);
    judge_lighting(clip, book);
    judge_times(experiment, clip, book);
  } else if (clip.seen < kFewSightings) {
    book.add(clip.seen < kUnusableSightings ? Severity::unusable : Severity::change, found::FewPositions{clip.seen});
  }
  for (const Note& note : clip.notes) {
    const bool reported =
        std::holds_alternative<RepeatedFrames>(note) ||
        (std::holds_alternative<MarkerOfOtherSize>(note) && size_disagrees(clip));  // above, with advice
    if (!reported) book.add(Severity::note, note);
  }
}

/// What the program assumes of a file on its own.
void note_assumptions(const std::vector<ClipSetup>& setups, std::vector<Finding>& findings) {
  for (const ClipSetup& setup : setups) {
    found::AssumedForFile assumed;
    if (setup.mass_assumed) assumed.mass_kg = setup.mass_kg;
    if (setup.incline_assumed) assumed.incline_deg = setup.incline_rad * base::kDegreesPerRad + 0.0;  // no "-0"
    if (!assumed.mass_kg && !assumed.incline_deg) continue;
    findings.push_back({Severity::note, {Subject::Part::clips, {setup.name}}, assumed});
  }
}

}  // namespace

std::vector<Finding> findings_of(const Experiment& experiment, const RecordingCheck& check) {
  std::vector<Finding> findings = statement_findings(experiment, check);
  if (check.pattern) judge_pattern(*check.pattern, {findings, {Subject::Part::pattern}});
  for (const ClipCheck& clip : check.clips) {
    // A wrong unit or a motion that is none explains what else is found.
    for (const ClipSetup& setup : experiment.clips) {
      if (setup.name != clip.name) continue;
      for (Finding& finding : motion_findings(clip.motion, setup, experiment.gravity_m_s2)) {
        findings.push_back(std::move(finding));
      }
    }
    judge_clip(experiment, clip, {findings, {Subject::Part::clips, {clip.name}}});
  }
  note_assumptions(experiment.clips, findings);
  findings = with_root_causes(experiment, check, std::move(findings));
  if (!check.plumb_failure.empty()) {
    findings.push_back({Severity::unusable, {Subject::Part::plumb_line}, found::NoPlumbAngle{check.plumb_failure}});
  }
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return static_cast<int>(a.severity) > static_cast<int>(b.severity);
  });
  return findings;
}

}  // namespace glidelab::core
