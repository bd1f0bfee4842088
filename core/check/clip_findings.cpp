#include "core/check/clip_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check/statement_findings.h"
#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {
namespace {

// What each limit rests on is in docs/reference/check.md.
constexpr std::size_t kFewestSightings = 20, kEnoughSightings = 60;
constexpr double kMostlySeen = 0.95, kPartlySeen = 2.0 / 3.0;
constexpr std::size_t kFewUnseen = 3;  // frames at a clip's start or end
constexpr double kInside = 0.95;       // of the marker's path
constexpr double kFineMarkerPx = 6.0, kWorstMarkerPx = 3.0;
constexpr double kFineContrast = 0.15, kFineSignal = 20.0, kWorstSignal = 5.0;
constexpr double kAtTheTop = 0.985, kTooDark = 0.25, kTooBright = 0.05;
constexpr double kFineBlur = 0.5, kWorstBlur = 2.0;           // marker diameters
constexpr double kWorstMissing = 0.01, kWorstRepeated = 0.1;  // shares of the frames
constexpr double kDrift = 0.75;                               // frames

std::string times(std::size_t count) {
  return count == 1 ? "once" : fmt::format("{} times", count);
}

void judge_times(const Experiment& experiment, const ClipCheck& clip, FindingBook& book) {
  const auto frames = static_cast<double>(std::max<std::size_t>(clip.frames, 1));
  const bool by_rate = experiment.camera->time == TimeSource::rate;
  if (clip.container_rate_hz && std::abs(*clip.container_rate_hz / clip.frame_rate_hz - 1.0) > kRateRounding) {
    book.add(by_rate ? Severity::change : Severity::note,
             fmt::format("the file says {:.6g} frames a second, experiment.toml {:.6g}", *clip.container_rate_hz,
                         clip.frame_rate_hz),
             fmt::format("make sure that it was filmed at {:.6g}: a wrong rate makes every speed wrong by as much{}",
                         clip.frame_rate_hz, by_rate ? "; a file meant for slow motion says its playing rate" : ""));
  }
  if (clip.drift_frames > kDrift) {
    book.add(by_rate ? Severity::unusable : Severity::note,
             fmt::format("the file's time stamps leave a uniform row by {:.3g} frames; {} steps are irregular",
                         clip.drift_frames, clip.irregular_steps),
             by_rate
                 ? "say time = \"container\" in [camera] if the camera films at a varying rate; else find out which "
                   "program lost frames"
                 : "");
  }
  if (clip.jumps > 0 && by_rate) {
    const double share = static_cast<double>(clip.jumps) / static_cast<double>(std::max<std::size_t>(clip.seen, 1));
    book.add(
        share > kWorstMissing ? Severity::unusable : Severity::change,
        fmt::format("the marker jumps {} by the way of whole frames: frames are missing", times(clip.jumps)),
        "record to a faster disk or in a smaller format, and say time = \"container\" if the file has true stamps");
  }
  if (clip.repeated + clip.stalls > 0) {
    const double share = static_cast<double>(std::max(clip.repeated, clip.stalls)) / frames;
    book.add(share > kWorstRepeated ? Severity::unusable : Severity::change,
             clip.stalls > 0
                 ? fmt::format("the marker stands still for a frame {} in mid-motion, and {} of {} frames are "
                               "the very picture before them: frames came twice",
                               times(clip.stalls), clip.repeated, clip.frames)
                 : fmt::format("{} of {} frames are the very picture before them", clip.repeated, clip.frames),
             "export the clip at the rate at which it was filmed; no converter may add frames");
  }
}

void judge_light(const ClipCheck& clip, FindingBook& book) {
  if (clip.marker_level && *clip.marker_level > kAtTheTop) {
    book.add(Severity::change, "the marker is as white as the camera can say",
             "shorten the exposure until it is grey: where it is clipped its edge is bent");
  }
  if (clip.saturated > kTooBright) {
    book.add(Severity::change,
             fmt::format("{} of the pixels are as white as the camera can say", percent(clip.saturated)),
             "shorten the exposure, or cover what is bright");
  }
  if (clip.bright_level < kTooDark) {
    book.add(Severity::change,
             fmt::format("the brightest parts reach {} of the camera's range", percent(clip.bright_level)),
             "use more light: noise is large in dark pictures");
  }
  if (clip.contrast && *clip.contrast < kFineContrast) {
    book.add(Severity::change,
             fmt::format("the marker stands out of its surroundings by {} of the range", percent(*clip.contrast)),
             "put a darker (or brighter) sheet behind it, or use a retroreflective marker with a lamp at the camera");
  }
  if (clip.contrast && *clip.contrast < kFineSignal * clip.pixel_noise) {
    const double signal = *clip.contrast / clip.pixel_noise;
    book.add(signal < kWorstSignal ? Severity::unusable : Severity::change,
             fmt::format("the marker's contrast is {:.3g} times the noise of a pixel", signal),
             "use more light and less gain (ISO)");
  }
}

/// A marker that is smeared away where the glider is fastest is missing at a clip's start or end.
void judge_ends(const ClipCheck& clip, FindingBook& book) {
  const std::size_t before = clip.first, after = clip.frames - clip.first - clip.spanned;
  const auto judge = [&](std::size_t unseen, bool edge, const std::string& found) {
    if (unseen <= kFewUnseen) return;
    const double share = static_cast<double>(unseen) / static_cast<double>(clip.frames);
    book.add(edge                        ? Severity::note
             : share > 1.0 - kPartlySeen ? Severity::unusable
                                         : Severity::change,
             found,
             edge
                 ? ""
                 : "it is not at the picture's edge there: where the glider is fast, shorten the exposure and use more "
                   "light; else cut the clip where the hand lets go");
  };
  judge(before, clip.entered, fmt::format("the marker is first seen in frame {} of {}", clip.first + 1, clip.frames));
  judge(after, clip.left,
        fmt::format("the marker is last seen in frame {} of {}", clip.first + clip.spanned, clip.frames));
}

void judge_marker(const ClipCheck& clip, FindingBook& book) {
  const double share = static_cast<double>(clip.seen) / static_cast<double>(std::max<std::size_t>(clip.spanned, 1));
  if (clip.seen < kEnoughSightings) {
    book.add(clip.seen < kFewestSightings ? Severity::unusable : Severity::change,
             fmt::format("the marker is seen in {} frames", clip.seen),
             "film at a higher rate, or let the glider run a longer way in the picture");
  }
  if (share < kMostlySeen) {
    book.add(share < kPartlySeen ? Severity::unusable : Severity::change,
             fmt::format("the marker is seen in {} of the {} frames between its first and its last", clip.seen,
                         clip.spanned),
             "nothing may hide it; more contrast, less blur");
  }
  judge_ends(clip, book);
  if (clip.marker_px < kFineMarkerPx) {
    book.add(clip.marker_px < kWorstMarkerPx ? Severity::unusable : Severity::change,
             fmt::format("the marker is {:.2g} px wide", clip.marker_px), "move closer or use a bigger one");
  }
  if (clip.measured_exposure_s) {
    book.add(
        Severity::change,
        fmt::format("the marker gets longer with its speed as by an exposure of {:.2g} ms{}",
                    1e3 * *clip.measured_exposure_s, clip.blur_px ? "; exposure_s says less than half of that" : ""),
        "read the exposure off the camera, and shorten it");
  }
  const double blur_px = likely_blur_px(clip);
  if (blur_px > kFineBlur * clip.marker_px) {
    const bool stated = clip.blur_px.has_value() || clip.measured_blur_px.has_value();
    book.add(stated && blur_px > kWorstBlur * clip.marker_px ? Severity::unusable : Severity::change,
             fmt::format("at its highest speed, {:.3g} m/s, the marker is smeared by {}{:.3g} px; it is {:.3g} px wide",
                         clip.top_speed_m_s, stated ? "" : "up to ", blur_px, clip.marker_px),
             stated ? "shorten the exposure and use more light"
                    : "state exposure_s in [camera] (an exposure as long as a frame would smear it so)");
  }
  if (clip.inside_pattern < kInside) {
    book.add(Severity::change,
             fmt::format("{} of the marker's path lies outside of where the pattern was ever seen",
                         percent(1.0 - clip.inside_pattern)),
             "take views of the pattern out to where the glider runs");
  }
}

}  // namespace

void judge_clip(const Experiment& experiment, const ClipCheck& clip, FindingBook book) {
  if (!clip.failure.empty()) {
    book.add(Severity::unusable, clip.failure,
             "see that the file plays, and that the marker is in the picture, moves, and is what [marker] says");
    return;
  }
  if (clip.pictures) {
    judge_marker(clip, book);
    judge_light(clip, book);
    judge_times(experiment, clip, book);
  } else if (clip.seen < kEnoughSightings) {
    book.add(clip.seen < kFewestSightings ? Severity::unusable : Severity::change,
             fmt::format("the track has {} points", clip.seen), "record at a higher rate");
  }
  for (const std::string& note : clip.notes) {
    const bool said = note.find("the very picture before them") != std::string::npos ||
                      (note.starts_with("the marker looks ") && size_disagrees(clip));  // above, with advice
    if (!said) book.add(Severity::note, note);
  }
}

}  // namespace glidelab::core
