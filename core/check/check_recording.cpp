#include "core/check/check_recording.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/errors.h"
#include "core/analysis/clip_to_track.h"
#include "core/check/check_clip.h"
#include "core/check/check_pattern.h"
#include "core/check/recording_findings.h"
#include "core/motion/analyze_motion.h"
#include "core/motion/join_configurations.h"
#include "core/pictures/scene/clip_look.h"
#include "core/track/track_csv.h"

namespace glidelab::core {
namespace {

// Times the stated diameter, for a marker that is not found: the tracker takes what is 0.75 to 1.33 times as large as
// it looks for; the last two are a decimal point.
constexpr std::array<double, 6> kOtherSizes = {1.6, 1.0 / 1.6, 2.5, 1.0 / 2.5, 10.0, 0.1};

/// A folder with this clip alone, and no plumb line.
Experiment alone(Experiment experiment, std::size_t clip) {
  experiment.clips = {experiment.clips[clip]};
  experiment.plumb.reset();
  std::erase_if(experiment.groups,
                [&](const GroupSetup& group) { return group.name != experiment.clips.front().group; });
  for (GroupSetup& group : experiment.groups) group.plumb.reset();
  return experiment;
}

/// All tracks at once, as the analysis takes them; where that fails, one by one, to see which clip it is.
std::vector<ClipAttempt> attempt_all(const Experiment& experiment, int jobs, const base::Progress& progress,
                                     ClipWatches& watches, const SeenPattern* seen_pattern, RecordingCheck& check) {
  std::vector<ClipAttempt> attempts(experiment.clips.size());
  // Tracks what `part` has, the first of whose clips is the experiment's clip `first`.
  const auto attempt = [&](const Experiment& part, std::size_t first) {
    PictureResults seen = tracks_of(part, jobs, progress, watches.opener(), false, seen_pattern);
    if (check.pattern) check.pattern->calibration = seen.calibration;
    check.plumbs.insert(check.plumbs.end(), seen.plumbs.begin(), seen.plumbs.end());
    for (std::size_t i = 0; i < seen.tracks.size(); ++i) {
      attempts[first + i].track = std::move(seen.tracks[i]);
      attempts[first + i].fits = std::move(seen.fits[i]);
    }
  };
  try {
    attempt(experiment, 0);
    return attempts;
  } catch (const base::InputError& error) {
    check.plumb_failure = error.what();  // unless a clip fails by itself
  }
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    try {
      attempt(alone(experiment, i), i);
    } catch (const base::InputError& error) {
      attempts[i].failure = error.what();
      check.plumb_failure.clear();
    }
  }
  // Clips share the marker: the size that one of them shows is looked for in the others first.
  std::vector<double> factors(kOtherSizes.begin(), kOtherSizes.end());
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    if (attempts[i].failure.empty() || experiment.clips[i].file.empty()) continue;
    const auto found = std::find_if(factors.begin(), factors.end(), [&](double factor) {
      Experiment other = alone(experiment, i);
      other.marker->diameter_m *= factor;
      try {
        attempt(other, i);
        return true;
      } catch (const base::InputError&) {
        return false;
      }
    });
    if (found == factors.end()) break;  // what one clip lacks in every size the others may lack too: it takes time
    attempts[i].track.notes.push_back("a marker of the stated diameter_m is not found: " +
                                      std::exchange(attempts[i].failure, {}));
    std::rotate(factors.begin(), found, found + 1);
  }
  return attempts;
}

/// Lines, and what they make of the inclination, of the clips that the analysis would take.
void analyze_motions(const Experiment& experiment, const std::vector<ClipAttempt>& attempts, RecordingCheck& check) {
  std::vector<ClipSetup> setups;
  std::vector<ClipResult> results;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    if (!attempts[i].failure.empty() || attempts[i].track.x_m.size() < kFewestTrackPoints) continue;
    setups.push_back(experiment.clips[i]);
    results.push_back(analyze_motion(setups.back(), attempts[i].track, {}));
    check.clips[i].against_launch = results.back().against_launch;
    if (check.clips[i].pictures) check.clips[i].jumps = results.back().lost_frames.size();
  }
  check.configurations = join_configurations(setups, results, experiment.gravity_m_s2);
}

}  // namespace

RecordingCheck check_recording(const Experiment& experiment, int jobs, const base::Progress& progress,
                               const FrameOpener& open) {
  require_clips(experiment);
  RecordingCheck check;
  check.name = experiment.name;
  progress("pattern", 0.0);
  std::optional<SeenPattern> seen_pattern;
  if (experiment.calibration) {
    CheckedPattern checked = check_pattern(experiment, jobs);
    check.pattern = std::move(checked.check);
    seen_pattern = std::move(checked.seen);
  }
  const bool no_camera = check.pattern && !check.pattern->failure.empty();
  ClipWatches watches(open);
  std::vector<ClipAttempt> attempts(experiment.clips.size());
  if (no_camera) {
    for (ClipAttempt& attempt : attempts) attempt.failure = "not looked at: there is no camera without the pattern";
  } else {
    attempts = attempt_all(experiment, jobs, progress, watches, seen_pattern ? &*seen_pattern : nullptr, check);
  }
  check.clips.resize(attempts.size());
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    check.clips[i] = check_clip(experiment, experiment.clips[i], attempts[i], watches);
  }
  for (ClipCheck& clip : check.clips) {
    if (check.pattern) clip.inside_pattern = share_inside(*check.pattern, clip.path).value_or(clip.inside_pattern);
  }
  analyze_motions(experiment, attempts, check);
  check.findings = findings_of(experiment, check);
  check.usable = std::none_of(check.findings.begin(), check.findings.end(),
                              [](const Finding& finding) { return finding.severity == Severity::unusable; });
  return check;
}

}  // namespace glidelab::core
