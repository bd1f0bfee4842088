#include "core/check/check_recording.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "base/errors.h"
#include "core/analysis/clip_to_track.h"
#include "core/check/check_clip.h"
#include "core/check/recording_findings.h"
#include "core/motion/analyze_motion.h"
#include "core/motion/configurations.h"
#include "core/pictures/camera/calibrate.h"
#include "core/pictures/camera/plane_fit.h"
#include "core/pictures/scene/clip_look.h"
#include "core/track/track_data.h"

namespace glidelab::core {
namespace {

constexpr int kAcross = 8, kDown = 6;  // parts of the image

double share_covered(const PatternCheck& pattern) {
  std::set<int> parts;
  for (const PatternView& view : pattern.views) {
    for (const PixelPlace& corner : view.corners) {
      const int across = static_cast<int>((corner.u_px + 0.5) / pattern.width_px * kAcross);
      const int down = static_cast<int>((corner.v_px + 0.5) / pattern.height_px * kDown);
      parts.insert(std::clamp(down, 0, kDown - 1) * kAcross + std::clamp(across, 0, kAcross - 1));
    }
  }
  return static_cast<double>(parts.size()) / (kAcross * kDown);
}

/// The images of the planes of motion.
std::set<std::filesystem::path> all_planes(const Experiment& experiment) {
  std::set<std::filesystem::path> planes(experiment.calibration->planes.begin(), experiment.calibration->planes.end());
  for (const GroupSetup& group : experiment.groups) planes.insert(group.planes.begin(), group.planes.end());
  return planes;
}

}  // namespace

CheckedPattern check_pattern(const Experiment& experiment, int jobs, const base::Progress& progress) {
  CheckedPattern checked;
  PatternCheck& pattern = checked.check;
  std::optional<SeenPattern>& seen = checked.seen;
  const double square_m = experiment.calibration->square_m;
  const std::set<std::filesystem::path> planes = all_planes(experiment);
  const BoardSize grid = experiment.calibration->inner_corners;
  BoardViews boards;
  try {
    boards = find_board_views(pattern_files(experiment), cv::Size(grid.columns, grid.rows), jobs,
                              most_pixels_of(experiment), progress);
    seen = SeenPattern{boards, calibrate_any_lens(boards, square_m)};
  } catch (const base::InputError& error) {
    pattern.failure = error.what();
  }
  pattern.width_px = boards.image_size.width;
  pattern.height_px = boards.image_size.height;
  for (const std::filesystem::path& file : boards.without) pattern.without.push_back(file.filename().string());
  for (const BoardView& board : boards.views) {
    PatternView view;
    view.file = board.file.filename().string();
    view.plane = planes.contains(board.file);
    for (const cv::Point2d& corner : board.corners.points) view.corners.push_back({corner.x, corner.y});
    if (seen) {
      const Calibration& camera = seen->calibration;
      const PlaneFit fit = fit_plane(camera.camera, {board.corners}, square_m, camera.noise.correlated_px);
      view.rms_px = fit.rms_px;
      view.tilt_deg = std::acos(std::min(1.0, std::abs(fit.pose.rotation(2, 2)))) * 180.0 / std::numbers::pi;
    }
    pattern.views.push_back(std::move(view));
  }
  if (!pattern.views.empty()) pattern.covered = share_covered(pattern);
  return checked;
}

std::optional<double> share_inside(const PatternCheck& pattern, const std::vector<PixelPlace>& path) {
  std::vector<cv::Point2f> corners, outline;
  for (const PatternView& view : pattern.views) {
    for (const PixelPlace& corner : view.corners) {
      corners.emplace_back(static_cast<float>(corner.u_px), static_cast<float>(corner.v_px));
    }
  }
  if (corners.size() < 3 || path.empty()) return std::nullopt;
  cv::convexHull(corners, outline);
  const auto inside = std::count_if(path.begin(), path.end(), [&](const PixelPlace& place) {
    const cv::Point2f here(static_cast<float>(place.u_px), static_cast<float>(place.v_px));
    return cv::pointPolygonTest(outline, here, false) >= 0.0;
  });
  return static_cast<double>(inside) / static_cast<double>(path.size());
}

namespace {

// Times the stated diameter, for a marker that is not found: the tracker accepts 0.75 to 1.33 times the size that it
// looks for; the last two stand for a wrong decimal point.
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

struct FailedClip {
  std::size_t clip = 0;
  std::string failure;
};

/// The clip that has no marker, unless several share its file.
std::optional<FailedClip> clip_without_marker(const Experiment& experiment, const NoMarker& none) {
  std::optional<FailedClip> failed;
  for (std::size_t i = 0; i < experiment.clips.size(); ++i) {
    if (experiment.clips[i].file.string() != none.issues().front().file) continue;
    if (failed) return std::nullopt;
    failed = {i, none.what()};
  }
  return failed;
}

/// All tracks at once, as in the analysis; if that fails, one by one, to see which clip is the cause.
std::vector<ClipAttempt> attempt_all(const Experiment& experiment, int jobs, const base::Progress& progress,
                                     ClipWatches& watches, const SeenPattern* seen_pattern, RecordingCheck& check) {
  std::vector<ClipAttempt> attempts(experiment.clips.size());
  // Tracks what `part` has, the first of whose clips is the experiment's clip `first`.
  const auto attempt = [&](const Experiment& part, std::size_t first, MarkerSearch search) {
    ImageResults seen = tracks_of(part, jobs, progress, watches.opener(), true, seen_pattern, search);
    if (check.pattern) check.pattern->calibration = seen.calibration;
    check.plumbs.insert(check.plumbs.end(), seen.plumbs.begin(), seen.plumbs.end());
    for (std::size_t i = 0; i < seen.tracks.size(); ++i) {
      attempts[first + i].track = std::move(seen.tracks[i]);
      attempts[first + i].fits = std::move(seen.fits[i]);
    }
  };
  // A length that is a hundred times too large leaves nothing to find, and the long searches are spared.
  const bool explained = explains_failures(experiment);
  const MarkerSearch stated_search = explained ? MarkerSearch::disc : MarkerSearch::thorough;
  std::optional<FailedClip> without_marker;  // known from the first attempt
  try {
    attempt(experiment, 0, stated_search);
    return attempts;
  } catch (const NoMarker& none) {
    without_marker = clip_without_marker(experiment, none);
    check.plumb_failure = none.what();
  } catch (const base::InputError& error) {
    check.plumb_failure = error.what();  // unless a clip fails by itself
  }
  // Clips share the marker: the size that one of them shows is looked for in the others first.
  std::vector<double> factors(kOtherSizes.begin(), kOtherSizes.end());
  bool other_size = false, no_size = explained;
  const auto failure_of = [&](std::size_t i) -> std::string {
    if (without_marker && without_marker->clip == i) return without_marker->failure;
    try {
      attempt(alone(experiment, i), i, other_size ? MarkerSearch::disc : stated_search);
      return {};
    } catch (const base::InputError& error) {
      return error.what();
    }
  };
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    attempts[i].failure = failure_of(i);
    if (attempts[i].failure.empty()) continue;
    check.plumb_failure.clear();
    if (no_size || experiment.clips[i].file.empty()) continue;
    const auto found = std::find_if(factors.begin(), factors.end(), [&](double factor) {
      Experiment other = alone(experiment, i);
      other.marker->diameter_m *= factor;
      try {
        attempt(other, i, MarkerSearch::disc);
        return true;
      } catch (const base::InputError&) {
        return false;
      }
    });
    // A marker that is not found in any size in one clip will hardly be found in the others, and each attempt takes
    // time.
    no_size = found == factors.end();
    if (no_size) continue;
    other_size = true;
    attempts[i].track.notes.emplace_back(NotOfStatedSize{std::exchange(attempts[i].failure, {})});
    std::rotate(factors.begin(), found, found + 1);
  }
  return attempts;
}

/// Between two stretches of free motion that have the same direction. Where it turns, it bounced, or stood still.
std::vector<Interruption> interruptions_of(std::span<const MotionPoint> points) {
  constexpr double kBack = 0.2;  // of the speed before: at rest it is noise
  std::vector<Interruption> found;
  std::optional<std::size_t> free;  // the last point that is used
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].left_out != LeftOut::used) continue;
    const auto between = points.subspan(free ? *free + 1 : i, free ? i - *free - 1 : 0);
    const auto handled = [](const MotionPoint& point) {
      return point.left_out == LeftOut::stop || point.left_out == LeftOut::hand || point.left_out == LeftOut::rest;
    };
    const auto first = std::find_if(between.begin(), between.end(), handled);
    if (first != between.end() && points[*free].v_m_s * points[i].v_m_s > 0.0) {
      const double before = points[*free].v_m_s;
      const bool turns = std::any_of(between.begin(), between.end(), [&](const MotionPoint& point) {
        return point.smoothed && point.v_m_s * before < -kBack * before * before;
      });
      const auto last = std::find_if(between.rbegin(), between.rend(), handled);
      if (!turns) found.push_back({first->t_s, last->t_s});
    }
    free = i;
  }
  return found;
}

/// The lines of the clips that the analysis would use, and the inclination that follows from them.
void analyze_motions(const Experiment& experiment, const std::vector<ClipAttempt>& attempts, RecordingCheck& check) {
  std::vector<ClipSetup> setups;
  std::vector<ClipResult> results;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    if (!attempts[i].failure.empty() || attempts[i].track.x_m.size() < kFewestTrackPoints) continue;
    setups.push_back(experiment.clips[i]);
    results.push_back(analyze_motion(setups.back(), attempts[i].track, {}));
    check.clips[i].against_launch = results.back().against_launch;
    check.clips[i].interruptions = interruptions_of(results.back().motion);
    // The noise that the analysis will state, in place of the first estimate; speeds alone have none.
    if (results.back().position_noise_m > 0.0) check.clips[i].position_noise_m = results.back().position_noise_m;
    if (check.clips[i].images) check.clips[i].jumps = results.back().lost_frames.size();
  }
  check.configurations = configurations_of_clips(setups, results, experiment.gravity_m_s2);
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
    CheckedPattern checked = check_pattern(experiment, jobs, progress);
    check.pattern = std::move(checked.check);
    seen_pattern = std::move(checked.seen);
  }
  const bool no_camera = check.pattern && !check.pattern->failure.empty();
  ClipWatches watches(open);
  std::vector<ClipAttempt> attempts(experiment.clips.size());
  if (no_camera) {
    for (ClipAttempt& attempt : attempts) attempt.failure = "not examined: without the pattern the camera is not known";
  } else {
    attempts = attempt_all(experiment, jobs, progress, watches, seen_pattern ? &*seen_pattern : nullptr, check);
  }
  check.clips.resize(attempts.size());
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    check.clips[i] = check_clip(experiment, experiment.clips[i], attempts[i], watches);
  }
  drop_contradicted_exposures(check.clips);
  for (ClipCheck& clip : check.clips) {
    if (check.pattern) clip.inside_pattern = share_inside(*check.pattern, clip.path).value_or(clip.inside_pattern);
  }
  analyze_motions(experiment, attempts, check);
  check.findings = findings_of(experiment, check);
  check.usable = std::none_of(check.findings.begin(), check.findings.end(),
                              [](const Finding& finding) { return finding.severity == Severity::unusable; });
  return check;
}

std::vector<Preview> previews_of_check(const Experiment& experiment, const RecordingCheck& check) {
  std::vector<Preview> previews;
  for (std::size_t i = 0; i < check.clips.size(); ++i) {
    ClipResult seen;
    seen.frames = check.clips[i].frames;
    seen.sightings = check.clips[i].sightings;
    PreviewOptions one;
    one.frames = 1;
    one.video = false;
    previews.push_back(make_preview(experiment, experiment.clips[i], seen, one));
  }
  return previews;
}

}  // namespace glidelab::core
