#include "core/check/recording_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
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
  const std::size_t asked = pattern.views.size() + pattern.without.size();
  if (!pattern.failure.empty()) {
    book.add(
        Severity::unusable, pattern.failure,
        fmt::format("the pattern was found in {} of {} images; retake them: the whole board in view, sharp, evenly "
                    "lit, with a white border, and inner_corners as printed",
                    pattern.views.size(), asked));
    return;
  }
  if (!pattern.without.empty()) {
    book.add(Severity::change, "no pattern is found in " + first_names(pattern.without),
             "retake these with all inner corners in view and the board evenly lit, or remove them");
  }
  if (!pattern.calibration) return;
  const CalibrationResult& camera = *pattern.calibration;
  if (camera.views_used < kFewViews) {
    book.add(Severity::change, fmt::format("the calibration uses {} views", camera.views_used),
             "take a dozen, tilted in all directions, near and far");
  }
  if (camera.rms_px > kMostPatternRmsPx) {
    book.add(camera.rms_px > kUnusablePatternRmsPx ? Severity::unusable : Severity::change,
             fmt::format("corners lie {:.2g} px (rms) from where the camera model places them", camera.rms_px),
             "glue the board to a flat plate, keep it still and sharp in every image, and leave zoom and focus alone");
  }
  if (pattern.covered < kLeastCovered) {
    book.add(Severity::change, fmt::format("the views cover {} of the image", percent_text(pattern.covered)),
             "hold the board near the edges and corners of the image as well: the lens is known only where the board "
             "was seen");
  }
  double tilt_deg = 0.0;
  for (const PatternView& view : pattern.views) tilt_deg = std::max(tilt_deg, view.tilt_deg);
  if (tilt_deg < kLeastTiltDeg) {
    book.add(Severity::change, fmt::format("the board is tilted by at most {:.0f} degrees", tilt_deg),
             "tilt it by 30 to 45 degrees in some views; otherwise the focal length is hardly determined");
  }
  if (camera.plane_rms_px > std::max(kLeastPlaneRmsPx, kMostPlaneOverNoise * camera.plane_expected_px)) {
    book.add(camera.plane_rms_px > kUnusablePlaneRmsPx ? Severity::unusable : Severity::change,
             fmt::format("the corners of the plane views lie {:.2g} px (rms) from where the camera places them; their "
                         "noise explains {:.2g} px",
                         camera.plane_rms_px, camera.plane_expected_px),
             "retake the plane view with the same focus, zoom and image size as all others, the board flat and still");
  }
  for (const Note& note : camera.notes) {
    if (!std::holds_alternative<NoPatternInSight>(note)) book.add(note);  // reported above, with advice
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

std::string times(std::size_t count) {
  return count == 1 ? "once" : fmt::format("{} times", count);
}

void judge_times(const Experiment& experiment, const ClipCheck& clip, FindingBook& book) {
  const auto frames = static_cast<double>(std::max<std::size_t>(clip.frames, 1));
  const bool by_rate = experiment.camera->time == TimeSource::rate;
  if (clip.container_rate_hz && std::abs(*clip.container_rate_hz / clip.frame_rate_hz - 1.0) > kRateRounding) {
    book.add(
        by_rate ? Severity::change : Severity::note,
        fmt::format("the file states {:.6g} frames per second, experiment.toml {:.6g}", *clip.container_rate_hz,
                    clip.frame_rate_hz),
        fmt::format("check that the clip was filmed at {:.6g} frames per second: a wrong rate scales every speed{}",
                    clip.frame_rate_hz, by_rate ? "; a slow-motion file states its playback rate" : ""),
        Topic::time);
  }
  if (clip.drift_frames > kMostDriftFrames) {
    book.add(
        by_rate ? Severity::unusable : Severity::note,
        fmt::format("the file's time stamps depart from even spacing by {:.3g} frames; {} steps are irregular",
                    clip.drift_frames, clip.irregular_steps),
        by_rate
            ? "set time = \"container\" in [camera] if the camera films at a varying rate; otherwise find out which "
              "program dropped frames"
            : "");
  }
  if (clip.jumps > 0 && by_rate) {
    const double share = static_cast<double>(clip.jumps) / static_cast<double>(std::max<std::size_t>(clip.seen, 1));
    book.add(
        share > kUnusableMissingShare ? Severity::unusable : Severity::change,
        fmt::format("the marker jumps {} by the distance of one or more frames: frames are missing", times(clip.jumps)),
        "record to a faster disk or in a smaller format; set time = \"container\" if the file's time stamps are true");
  }
  if (clip.repeated + clip.stalls > 0) {
    const double share = static_cast<double>(std::max(clip.repeated, clip.stalls)) / frames;
    book.add(share > kUnusableRepeatedShare ? Severity::unusable : Severity::change,
             clip.stalls > 0
                 ? fmt::format(
                       "the marker stands still for a frame {} in mid-motion, and {} of {} frames are identical to the "
                       "frame before: frames are duplicated",
                       times(clip.stalls), clip.repeated, clip.frames)
                 : fmt::format("{} of {} frames are identical to the frame before", clip.repeated, clip.frames),
             "export the clip at the rate at which it was filmed, with a converter that adds no frames");
  }
}

void judge_light(const ClipCheck& clip, FindingBook& book) {
  if (clip.marker_level && *clip.marker_level > kSaturatedLevel) {
    book.add(Severity::change, "the marker is saturated",
             "shorten the exposure until it is grey: saturation displaces its edge");
  }
  if (clip.saturated > kMostSaturatedShare) {
    book.add(Severity::change, fmt::format("{} of the pixels are saturated", percent_text(clip.saturated)),
             "shorten the exposure, or cover bright surfaces");
  }
  if (clip.bright_level < kLeastBrightLevel) {
    book.add(Severity::change,
             fmt::format("the brightest parts reach only {} of the camera's range", percent_text(clip.bright_level)),
             "use more light: dark images are noisy");
  }
  if (clip.contrast && *clip.contrast < kLeastContrast) {
    book.add(Severity::change,
             fmt::format("the marker differs from its surroundings by only {} of the camera's range",
                         percent_text(*clip.contrast)),
             "put a darker (or brighter) sheet behind it, or use a retroreflective marker with a lamp at the camera");
  }
  if (clip.contrast && *clip.contrast < kLeastSignalToNoise * clip.pixel_noise) {
    const double signal = *clip.contrast / clip.pixel_noise;
    book.add(signal < kUnusableSignalToNoise ? Severity::unusable : Severity::change,
             fmt::format("the marker's contrast is {:.3g} times the noise of a pixel", signal),
             "use more light and less gain (ISO)");
  }
}

/// Light that varies with position, and its effect on the marker's apparent centre.
void judge_lighting(const ClipCheck& clip, FindingBook& book) {
  if (!clip.light) return;
  const double px_per_m = clip.top_speed_m_s > 0.0 ? clip.top_speed_px_s / clip.top_speed_m_s : 0.0;
  const auto length = [&](double px) {
    return px_per_m > 0.0 ? fmt::format("{:.2g} px ({:.2g} mm)", px, 1e3 * px / px_per_m)
                          : fmt::format("{:.2g} px", px);
  };
  if (clip.light->pull_change_px > kMostPullChange_px) {
    book.add(
        Severity::change,
        fmt::format("light from one side: the marker's brightness is centred {} from its outline's centre, and that "
                    "changes by ±{} along the path",
                    length(clip.light->pull_px), length(clip.light->pull_change_px)),
        "light the track evenly, with a second lamp from the other side or through a diffuser: the analysis fits "
        "the outline, but where the lit part alone stands out, that is less certain");
  } else if (clip.light->pull_px > kLargePull * clip.marker_px) {
    book.add(
        Severity::note,
        fmt::format("light from one side: the marker's brightness is centred {} from its outline's centre, the same "
                    "along the path to within ±{}",
                    length(clip.light->pull_px), length(clip.light->pull_change_px)),
        "");
  }
  if (clip.light->least_contrast < kLeastContrastAlong) {
    book.add(Severity::change,
             fmt::format("the marker's contrast falls to {} of its largest along the path",
                         percent_text(clip.light->least_contrast)),
             "move lamps, and bright or dark objects in the background, away from the marker's path");
  }
}

/// A marker that is smeared away where the glider is fastest is missing at a clip's start or end.
void judge_ends(const ClipCheck& clip, FindingBook& book) {
  const std::size_t before = clip.first, after = clip.frames - clip.first - clip.spanned;
  const auto judge = [&](std::size_t unseen, bool edge, const std::string& found) {
    if (unseen <= kMostUnseenAtEnd) return;
    const double share = static_cast<double>(unseen) / static_cast<double>(clip.frames);
    book.add(
        edge                               ? Severity::note
        : share > 1.0 - kUnusableSeenShare ? Severity::unusable
                                           : Severity::change,
        found,
        edge ? ""
             : "the marker is not at the edge of the image there: if the glider is fast, shorten the exposure and use "
               "more light; otherwise cut the clip where the hand lets go");
  };
  judge(before, clip.entered, fmt::format("the marker is first seen in frame {} of {}", clip.first + 1, clip.frames));
  judge(after, clip.left,
        fmt::format("the marker is last seen in frame {} of {}", clip.first + clip.spanned, clip.frames));
}

void judge_marker(const ClipCheck& clip, FindingBook& book) {
  const double share = static_cast<double>(clip.seen) / static_cast<double>(std::max<std::size_t>(clip.spanned, 1));
  if (clip.seen < kFewSightings) {
    book.add(clip.seen < kUnusableSightings ? Severity::unusable : Severity::change,
             fmt::format("the marker is seen in only {} frames", clip.seen),
             "film at a higher rate, or let the glider run a longer distance in the image");
  }
  if (share < kLeastSeenShare) {
    book.add(share < kUnusableSeenShare ? Severity::unusable : Severity::change,
             fmt::format("the marker is seen in {} of the {} frames between its first and its last sighting", clip.seen,
                         clip.spanned),
             "make sure that nothing hides it; increase the contrast, reduce the blur");
  }
  judge_ends(clip, book);
  if (clip.marker_px < kSmallMarkerPx) {
    book.add(clip.marker_px < kUnusableMarkerPx ? Severity::unusable : Severity::change,
             fmt::format("the marker is {:.2g} px wide", clip.marker_px), "move closer or use a bigger one");
  }
  if (clip.measured_exposure_s) {
    book.add(Severity::change,
             fmt::format("the marker lengthens with its speed as it would with an exposure of {:.2g} ms{}",
                         1e3 * *clip.measured_exposure_s, clip.blur_px ? "; exposure_s is less than half of that" : ""),
             "read the exposure from the camera, and shorten it");
  }
  const double blur_px = likely_blur_px(clip);
  if (blur_px > kMostBlur * clip.marker_px) {
    const bool stated = clip.blur_px.has_value() || clip.measured_blur_px.has_value();
    book.add(stated && blur_px > kUnusableBlur * clip.marker_px ? Severity::unusable : Severity::change,
             fmt::format("at its top speed, {:.3g} m/s, the marker is smeared by {}{:.3g} px; it is {:.3g} px wide",
                         clip.top_speed_m_s, stated ? "" : "up to ", blur_px, clip.marker_px),
             stated ? "shorten the exposure and use more light"
                    : "state exposure_s in [camera] (this is the smear of an exposure as long as the frame time)");
  }
  if (clip.inside_pattern < kLeastPathInside) {
    book.add(Severity::change,
             fmt::format("{} of the marker's path lies outside the region in which the pattern was seen",
                         percent_text(1.0 - clip.inside_pattern)),
             "take views of the pattern that cover the region in which the glider runs");
  }
}

void judge_clip(const Experiment& experiment, const ClipCheck& clip, FindingBook book) {
  if (!clip.failure.empty()) {
    book.add(
        Severity::unusable, clip.failure,
        clip.pictures
            ? "check that the file plays, that the marker is in the image and moves, and that [marker] describes it"
            : "repair the file, or state what it lacks",
        Topic::failure);
    return;
  }
  if (clip.pictures) {
    judge_marker(clip, book);
    judge_light(clip, book);
    judge_lighting(clip, book);
    judge_times(experiment, clip, book);
  } else if (clip.seen < kFewSightings) {
    book.add(clip.seen < kUnusableSightings ? Severity::unusable : Severity::change,
             fmt::format("the track has {} points", clip.seen), "record at a higher rate");
  }
  for (const Note& note : clip.notes) {
    const bool reported =
        std::holds_alternative<RepeatedFrames>(note) ||
        (std::holds_alternative<MarkerOfOtherSize>(note) && size_disagrees(clip));  // above, with advice
    if (!reported) book.add(note);
  }
}

/// A finding that several clips share is reported once; of notes, report/ says which read the same.
std::vector<Finding> merged(std::vector<Finding> findings) {
  std::vector<Finding> once;
  std::vector<std::vector<std::string>> about;
  for (Finding& finding : findings) {
    const auto same = std::find_if(once.begin(), once.end(), [&](const Finding& before) {
      return !before.note && !finding.note &&
             std::tie(before.severity, before.found, before.advice) ==
                 std::tie(finding.severity, finding.found, finding.advice);
    });
    if (same != once.end()) {
      about[static_cast<std::size_t>(same - once.begin())].push_back(finding.about);
      continue;
    }
    about.push_back({finding.about});
    once.push_back(std::move(finding));
  }
  for (std::size_t i = 0; i < once.size(); ++i) once[i].about = first_names(about[i]);
  return once;
}

}  // namespace

std::vector<Finding> findings_of(const Experiment& experiment, const RecordingCheck& check) {
  std::vector<Finding> findings = statement_findings(experiment, check);
  if (check.pattern) judge_pattern(*check.pattern, {findings, "pattern"});
  for (const ClipCheck& clip : check.clips) {
    // A wrong unit or a motion that is none explains what else is found.
    for (const ClipSetup& setup : experiment.clips) {
      if (setup.name != clip.name) continue;
      for (Finding& finding : motion_findings(clip.motion, setup, experiment.gravity_m_s2)) {
        findings.push_back(std::move(finding));
      }
    }
    judge_clip(experiment, clip, {findings, clip.name});
  }
  for (const ClipSetup& setup : experiment.clips) {
    if (setup.launched != Launched::unknown) continue;
    findings.push_back(
        {Severity::note, setup.name,
         fmt::format("a single file: its mass is taken as {:.6g} kg and its inclination as {:.4g}°", setup.mass_kg,
                     setup.incline_rad * base::kDegreesPerRad + 0.0),
         "--mass and --incline state others; where no force is recorded, K/m, µ and α do not depend on them"});
  }
  findings = with_root_causes(experiment, check, std::move(findings));
  if (!check.plumb_failure.empty()) findings.push_back({Severity::unusable, "plumb line", check.plumb_failure, {}});
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return static_cast<int>(a.severity) > static_cast<int>(b.severity);
  });
  return merged(std::move(findings));
}

}  // namespace glidelab::core
