#include "core/check_recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>

#include "base/errors.h"
#include "core/calibrate_fisheye.h"
#include "core/camera_and_planes.h"
#include "core/clip_look.h"
#include "core/clip_to_track.h"
#include "core/marker_smear.h"
#include "core/median.h"
#include "core/noise.h"
#include "core/phase_diagram.h"
#include "core/quantile.h"
#include "core/restitution.h"
#include "core/track_csv.h"

namespace glidelab::core {
namespace {

constexpr double kTopSpeed = 0.99;    // quantile: single frames may be wrong
constexpr std::size_t kSpeedLag = 4;  // frames over which a speed is taken
constexpr std::size_t kPathPlaces = 200;
constexpr int kAcross = 8, kDown = 6;  // parts of the picture
// Times the stated diameter, for a marker that is not found: the tracker takes what is 0.75 to 1.33 times as large as
// it looks for; the last two are a decimal point.
constexpr std::array<double, 6> kOtherSizes = {1.6, 1.0 / 1.6, 2.5, 1.0 / 2.5, 10.0, 0.1};
constexpr double kBeyondTone = 2.0;   // times the stated exposure
constexpr double kBeyondPlace = 0.5;  // marker diameters: less a marker may lengthen by where it is (perspective)
// A step counts as a stall where the two on either side lie within an eighth of a straight line, and the rest of it is
// six standard deviations of its noise: a clip has thousands of steps, and a codec's errors are no bell.
constexpr double kAgree = 0.125, kStall = 0.4, kClearOfNoise = 15.0;

struct Speeds {
  double px_s = 0.0, m_s = 0.0;
  double px_per_m = 0.0;  ///< along the path; 0 where nothing moves
};

Speeds speeds_of(const TrackData& track) {
  std::vector<double> px_s, m_s;
  double px = 0.0, m = 0.0;
  for (std::size_t i = kSpeedLag; i < track.x_m.size(); ++i) {
    const std::size_t k = i - kSpeedLag;
    const double dt_s = track.t_s[i] - track.t_s[k];
    if (track.frame[i] - track.frame[k] != kSpeedLag) continue;
    const double way_m = std::abs(track.x_m[i] - track.x_m[k]);
    m_s.push_back(way_m / dt_s);
    if (track.sightings.empty()) continue;
    const double way_px = std::hypot(track.sightings[i].u_px - track.sightings[k].u_px,
                                     track.sightings[i].v_px - track.sightings[k].v_px);
    px_s.push_back(way_px / dt_s);
    px += way_px;
    m += way_m;
  }
  return {quantile(px_s, kTopSpeed), quantile(m_s, kTopSpeed), m > 0.0 ? px / m : 0.0};
}

/// Steps from frame to frame that are far shorter than their neighbours, of which two on either side agree.
std::size_t stalls_of(const std::vector<MarkerSighting>& sightings, double noise_px) {
  std::size_t stalls = 0;
  const auto step = [&](std::size_t i) {
    return std::hypot(sightings[i + 1].u_px - sightings[i].u_px, sightings[i + 1].v_px - sightings[i].v_px);
  };
  for (std::size_t i = 2; i + 3 < sightings.size(); ++i) {
    if (sightings[i + 3].frame - sightings[i - 2].frame != 5) continue;
    const std::array<double, 4> around = {step(i - 2), step(i - 1), step(i + 1), step(i + 2)};
    // A speed that changes evenly makes the four a straight line.
    const double middle = 0.25 * (around[0] + around[1] + around[2] + around[3]);
    const double rise = 0.1 * (2.0 * (around[3] - around[0]) + around[2] - around[1]);
    const std::array<double, 4> place = {-2.0, -1.0, 1.0, 2.0};
    double off = 0.0;
    for (std::size_t k = 0; k < 4; ++k) off = std::max(off, std::abs(around[k] - middle - rise * place[k]));
    if (middle < kClearOfNoise * noise_px || off > kAgree * middle) continue;
    stalls += step(i) < kStall * middle ? 1 : 0;
  }
  return stalls;
}

/// One track with the fits behind it, or why there is none.
struct Attempt {
  TrackData track;
  std::vector<MarkerFit> fits;
  std::string failure;
};

/// Closer to the picture's edge than a marker's diameter and a half, and its smear: it may have come from outside.
bool at_edge(const MarkerSighting& sighting, const ClipCheck& clip) {
  const double margin_px = 3.0 * sighting.radius_px + clip.measured_blur_px.value_or(clip.blur_px.value_or(0.0));
  return std::min({sighting.u_px, sighting.v_px, clip.width_px - 1.0 - sighting.u_px,
                   clip.height_px - 1.0 - sighting.v_px}) < margin_px;
}

ClipCheck check_clip(const Experiment& experiment, const ClipSetup& setup, const Attempt& attempt,
                     const ClipWatches& watches) {
  const TrackData& track = attempt.track;
  ClipCheck clip;
  clip.name = setup.name;
  clip.pictures = !setup.file.empty();
  clip.failure = attempt.failure;
  if (!clip.failure.empty()) return clip;
  clip.notes = track.notes;
  clip.frames = track.frame_t_s.size();
  clip.seen = track.x_m.size();
  if (!track.frame.empty()) {
    clip.first = track.frame.front();
    clip.spanned = track.frame.back() - clip.first + 1;
  }
  clip.frame_rate_hz = track.frame_rate_hz;
  if (track.x_m.size() >= kFewestTrackPoints) clip.position_noise_m = pilot_noise(track.t_s, track.x_m);
  if (!track.x_m.empty()) {
    const auto [least, most] = std::minmax_element(track.x_m.begin(), track.x_m.end());
    clip.way_m = *most - *least;
  }
  const Speeds speeds = speeds_of(track);
  clip.top_speed_m_s = speeds.m_s;
  clip.top_speed_px_s = speeds.px_s;
  if (!clip.pictures || track.sightings.empty()) return clip;
  MarkerSetup marker = *experiment.marker;
  if (track.dark_marker) marker.color_bgr = cv::Vec3b(0, 0, 0);
  const ClipLook look = watches.of(setup.file).look(marker, track.sightings, attempt.fits);
  clip.width_px = look.size.width;
  clip.height_px = look.size.height;
  clip.container_rate_hz = look.file.container_rate_hz;
  clip.repeated = look.file.repeated;
  clip.irregular_steps = look.file.irregular_steps;
  clip.drift_frames = look.file.drift_frames;
  clip.saturated = look.exposure.saturated;
  clip.dark = look.exposure.dark;
  clip.bright_level = look.exposure.bright_level;
  clip.contrast = look.contrast;
  clip.marker_level = look.marker_level;
  clip.pixel_noise = look.pixel_noise;
  std::vector<double> radii, sds;
  for (const MarkerSighting& sighting : track.sightings) {
    radii.push_back(sighting.radius_px);
    sds.push_back(sighting.sd_px);
  }
  clip.marker_px = 2.0 * median_of(radii);
  clip.centre_sd_px = median_of(sds);
  clip.marker_expected_px = experiment.marker->diameter_m * speeds.px_per_m;
  const CameraSettings& camera = *experiment.camera;
  if (camera.exposure_s) clip.blur_px = speeds.px_s * *camera.exposure_s;
  if (const auto smear = marker_smear(track.sightings, attempt.fits, camera.frame_rate_hz)) {
    const double blur_px = speeds.px_s * smear->exposure_s;
    const bool longer = !camera.exposure_s || smear->exposure_s > kBeyondTone * *camera.exposure_s;
    if (longer && blur_px > kBeyondPlace * clip.marker_px) {
      clip.measured_exposure_s = smear->exposure_s;
      clip.measured_blur_px = blur_px;
    }
  }
  clip.entered = at_edge(track.sightings.front(), clip);
  clip.left = at_edge(track.sightings.back(), clip);
  clip.longest_blur_px = speeds.px_s / camera.frame_rate_hz;
  clip.stalls =
      stalls_of(track.sightings, std::max(clip.centre_sd_px, clip.position_noise_m.value_or(0.0) * speeds.px_per_m));
  const std::size_t every = track.sightings.size() / kPathPlaces + 1;
  for (std::size_t i = 0; i < track.sightings.size(); i += every) {
    clip.path.push_back({track.sightings[i].u_px, track.sightings[i].v_px});
  }
  clip.sightings = track.sightings;
  return clip;
}

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

/// The pictures of the planes of motion.
std::set<std::filesystem::path> all_planes(const Experiment& experiment) {
  std::set<std::filesystem::path> planes(experiment.calibration->planes.begin(), experiment.calibration->planes.end());
  for (const GroupSetup& group : experiment.groups) planes.insert(group.planes.begin(), group.planes.end());
  return planes;
}

/// What the pictures of the pattern show; `seen` becomes the corners and the camera, where there is one.
PatternCheck check_pattern(const Experiment& experiment, int jobs, std::optional<SeenPattern>& seen) {
  PatternCheck pattern;
  const double square_m = experiment.calibration->square_m;
  const std::set<std::filesystem::path> planes = all_planes(experiment);
  BoardViews boards;
  try {
    boards = find_board_views(pattern_files(experiment), experiment.calibration->inner_corners, jobs);
    seen = SeenPattern{boards, calibrate_any_lens(boards, square_m)};
  } catch (const base::InputError& error) {
    pattern.failure = error.what();
  }
  pattern.width_px = boards.picture_size.width;
  pattern.height_px = boards.picture_size.height;
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
  return pattern;
}

/// How much of each clip's path lies where the lens is known.
void measure_inside(const PatternCheck& pattern, std::vector<ClipCheck>& clips) {
  std::vector<cv::Point2f> corners, outline;
  for (const PatternView& view : pattern.views) {
    for (const PixelPlace& corner : view.corners) {
      corners.emplace_back(static_cast<float>(corner.u_px), static_cast<float>(corner.v_px));
    }
  }
  if (corners.size() < 3) return;
  cv::convexHull(corners, outline);
  for (ClipCheck& clip : clips) {
    if (clip.path.empty()) continue;
    const auto inside = std::count_if(clip.path.begin(), clip.path.end(), [&](const PixelPlace& place) {
      const cv::Point2f here(static_cast<float>(place.u_px), static_cast<float>(place.v_px));
      return cv::pointPolygonTest(outline, here, false) >= 0.0;
    });
    clip.inside_pattern = static_cast<double>(inside) / static_cast<double>(clip.path.size());
  }
}

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
std::vector<Attempt> attempt_all(const Experiment& experiment, int jobs, const base::Progress& progress,
                                 ClipWatches& watches, const SeenPattern* seen_pattern, RecordingCheck& check) {
  std::vector<Attempt> attempts(experiment.clips.size());
  /// Tracks what `part` has, the first of whose clips is the experiment's clip `first`.
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
void analyze_motions(const Experiment& experiment, const std::vector<Attempt>& attempts, RecordingCheck& check) {
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
  if (experiment.clips.empty()) {
    throw base::InputError(base::Issue{experiment.file.string(), 0, "clip", "none", "one or more clips or tracks"});
  }
  RecordingCheck check;
  check.name = experiment.name;
  progress("pattern", 0.0);
  std::optional<SeenPattern> seen_pattern;
  if (experiment.calibration) check.pattern = check_pattern(experiment, jobs, seen_pattern);
  const bool no_camera = check.pattern && !check.pattern->failure.empty();
  ClipWatches watches(open);
  std::vector<Attempt> attempts(experiment.clips.size());
  if (no_camera) {
    for (Attempt& attempt : attempts) attempt.failure = "not looked at: there is no camera without the pattern";
  } else {
    attempts = attempt_all(experiment, jobs, progress, watches, seen_pattern ? &*seen_pattern : nullptr, check);
  }
  check.clips.resize(attempts.size());
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    check.clips[i] = check_clip(experiment, experiment.clips[i], attempts[i], watches);
  }
  if (check.pattern) measure_inside(*check.pattern, check.clips);
  analyze_motions(experiment, attempts, check);
  check.findings = findings_of(experiment, check);
  check.usable = std::none_of(check.findings.begin(), check.findings.end(),
                              [](const Finding& finding) { return finding.severity == Severity::unusable; });
  return check;
}

}  // namespace glidelab::core
