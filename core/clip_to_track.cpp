#include "core/clip_to_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/errors.h"
#include "base/parallel.h"
#include "core/camera_and_planes.h"
#include "core/even_times.h"
#include "core/frame_source.h"
#include "core/marker_track.h"
#include "core/mode_axis.h"
#include "core/motion_axis.h"
#include "core/plumb.h"
#include "core/scene_watch.h"
#include "core/track_csv.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

constexpr double kSlantedRad = 15.0 * std::numbers::pi / 180.0;  // "X lies along the track up to a few degrees"

// A marker whose brightness nobody states: of the frames from its first to its last, in how many a good one is seen;
// and in how many times as many as a bright one a dark one must be.
constexpr double kWellSeen = 0.9, kFarBetter = 1.2;

int downhill_of(const Experiment& experiment, const std::string& name) {
  const GroupSetup* group = group_of(experiment, name);
  return group != nullptr && group->downhill ? *group->downhill : experiment.track.downhill;
}

/// What one clip's pictures say, in pixels.
struct SeenClip {
  TrackedMarker marker;
  std::vector<double> frame_t_s;
  cv::Size size;
  std::vector<std::string> notes;
  std::shared_ptr<PictureRecord> pictures;  ///< where they are asked for
  bool dark_marker = false;

  bool moves() const {
    return std::any_of(marker.sightings.begin(), marker.sightings.end(), [&](const MarkerSighting& sighting) {
      const MarkerSighting& first = marker.sightings.front();
      return std::hypot(sighting.u_px - first.u_px, sighting.v_px - first.v_px) > 1.5 * first.radius_px;
    });
  }
  /// In most frames from the first sighting to the last, of something that moves.
  bool well_seen() const {
    if (!moves()) return false;
    const std::size_t span = marker.sightings.back().frame - marker.sightings.front().frame + 1;
    return static_cast<double>(marker.sightings.size()) > kWellSeen * static_cast<double>(span);
  }
};

/// Counts frames over all clips for the progress.
class FrameCounter {
 public:
  FrameCounter(const base::Progress& progress, std::size_t clips) : progress_(progress), clips_(clips) {}
  /// Tells how far all clips are, this clip's share having grown by `share`.
  void add(double share) {
    double now = done_.load();
    while (!done_.compare_exchange_weak(now, now + share)) {
    }
    progress_("frames", std::min(1.0, (now + share) / static_cast<double>(clips_)));
  }

 private:
  const base::Progress& progress_;
  std::size_t clips_;
  std::atomic<double> done_ = 0.0;
};

/// The marker's image in each frame, from the fits that found it.
std::vector<MarkerLook> looks_of(const TrackedMarker& marker, const std::vector<double>& frame_t_s) {
  std::vector<MarkerLook> looks;
  for (std::size_t i = 0; i < marker.fits.size(); ++i) {
    const MarkerFit& fit = marker.fits[i];
    const cv::Vec3d& m = fit.shape;
    const double determinant = m[0] * m[2] - m[1] * m[1];
    if (!(determinant > 0.0)) continue;  // a centroid has no outline
    // An ellipse |M d| = 1 has the moments M^-2 / 4.
    const double a = m[2] / determinant, b = -m[1] / determinant, c = m[0] / determinant;
    const std::size_t frame = marker.sightings[i].frame;
    looks.push_back({frame, frame_t_s[frame], fit.centre.x, fit.centre.y, fit.moments[0] - fit.moments[2],
                     0.25 * b * (a + c), 0.25 * (b * b + c * c), fit.blur_px, fit.amplitude, fit.background,
                     fit.slope_u, fit.slope_v});
  }
  return looks;
}

/// Times of an even camera instead of its rounded stamps.
void put_even(SeenClip& seen) {
  std::optional<EvenTimes> even = even_times(seen.frame_t_s);
  if (!even) return;
  seen.notes.push_back(
      fmt::format("the container's time stamps are whole multiples of {:.4g} ms, and frames at an even distance of "
                  "{:.6g} ms (to {:.0f} parts in a million) explain them all: these times count",
                  even->tick_s * 1e3, even->step_s * 1e3, std::ceil(even->half_width_s / even->step_s * 1e6)));
  seen.frame_t_s = std::move(even->t_s);
}

SeenClip look_for(const MarkerSetup& marker, const Experiment& experiment, const ClipSetup& clip,
                  const CameraAndPlanes& setting, const FrameOpener& open, bool look_at_scene, FrameCounter& counter) {
  const bool with_color = signal_kind(marker) == SignalKind::colored;
  const auto source = open(clip.file, *experiment.camera, with_color, setting.size);
  const Restitution& restitution = setting.restitutions.at(clip.group);
  // Where no ray belongs to a pixel (far outside the calibrated field) the marker is as large as elsewhere.
  double usual_px = 0.0;
  const auto radius_at = [&](cv::Point2d pixel) {
    const auto radius = restitution.marker_radius_px(pixel);
    if (radius) usual_px = usual_px == 0.0 ? *radius : usual_px;
    return radius.value_or(usual_px == 0.0 ? 5.0 : usual_px);
  };
  MarkerTracker tracker(clip.file, marker, radius_at);
  SeenClip seen;
  const double stated = static_cast<double>(std::max<std::size_t>(source->stated_frames(), 1));
  constexpr std::size_t kTellEvery = 10;
  std::optional<SceneWatch> scene;
  if (look_at_scene) {
    scene.emplace(source->facts().lossy.value_or(false));
    seen.pictures = std::make_shared<PictureRecord>();
  }
  while (const auto frame = look_at_scene ? source->next() : source->next_in_parts()) {
    seen.size = frame->grey.size();
    seen.frame_t_s.push_back(frame->t_s);
    tracker.add(*frame);
    if (scene) {
      scene->add(frame->grey, frame->t_s);
      seen.pictures->full_code = frame->grey.depth() == CV_8U ? 255.0 : 65535.0;
    }
    if (seen.frame_t_s.size() % kTellEvery == 0) counter.add(static_cast<double>(kTellEvery) / stated);
  }
  seen.marker = tracker.finish();
  seen.notes = source->notes();
  if (experiment.camera->time == TimeSource::container) put_even(seen);
  if (scene) {
    const FileFacts facts = source->facts();
    seen.pictures->width_px = seen.size.width;
    seen.pictures->height_px = seen.size.height;
    seen.pictures->codec = facts.codec;
    seen.pictures->lossy = facts.lossy;
    seen.pictures->stamps_missing = facts.stamps_missing;
    seen.pictures->marker = looks_of(seen.marker, seen.frame_t_s);
    scene->finish(*seen.pictures);
  }
  seen.notes.insert(seen.notes.end(), seen.marker.notes.begin(), seen.marker.notes.end());
  return seen;
}

/// As the marker's colour says; without one by its brightness: the disc is bright, or, where such a one is hardly seen
/// and a dark one well, dark.
SeenClip look_at(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                 const FrameOpener& open, bool look_at_scene, FrameCounter& counter) {
  const auto look = [&](const MarkerSetup& marker) {
    return look_for(marker, experiment, clip, setting, open, look_at_scene, counter);
  };
  if (experiment.marker->color_bgr) return look(*experiment.marker);
  std::optional<SeenClip> bright;
  std::optional<NoMarker> no_bright;
  try {
    bright = look(*experiment.marker);
    if (bright->well_seen()) return *std::move(bright);
  } catch (const NoMarker& nothing) {
    no_bright = nothing;
  }
  MarkerSetup dark = *experiment.marker;
  dark.color_bgr = cv::Vec3b(0, 0, 0);
  try {
    SeenClip seen = look(dark);
    const double others = bright && bright->moves() ? static_cast<double>(bright->marker.sightings.size()) : 0.0;
    if (seen.well_seen() && static_cast<double>(seen.marker.sightings.size()) > kFarBetter * others) {
      seen.dark_marker = true;
      seen.notes.emplace_back(
          "the marker is darker than its surroundings, as color = \"#101010\" in [marker] would say");
      return seen;
    }
  } catch (const base::InputError&) {
    // No single dark one either: what there is of the bright one is what counts.
  }
  if (no_bright) throw NoMarker(*no_bright);
  return *std::move(bright);
}

struct PlanePoint {
  MarkerSighting sighting;
  cv::Point2d place;
};

std::vector<PlanePoint> restituted(const SeenClip& seen, const Restitution& restitution) {
  std::vector<PlanePoint> points;
  for (const MarkerSighting& sighting : seen.marker.sightings) {
    const auto place = restitution.to_plane({sighting.u_px, sighting.v_px});
    if (place) points.push_back({sighting, *place});
  }
  return points;
}

TrackData track_from(const SeenClip& seen, const std::vector<PlanePoint>& points, const MotionAxis& axis,
                     const CameraSettings& camera, const Restitution& restitution) {
  TrackData track;
  track.frame_rate_hz = camera.frame_rate_hz;
  track.frame_t_s = seen.frame_t_s;
  track.notes = seen.notes;
  track.pictures = seen.pictures;
  track.dark_marker = seen.dark_marker;
  for (const PlanePoint& point : points) {
    track.frame.push_back(point.sighting.frame);
    // A rolling shutter exposes the marker's row later than the picture's middle row, to which the frame's time
    // belongs.
    const double row = point.sighting.v_px - 0.5 * (seen.size.height - 1);
    const double delay_s = camera.line_readout_s * (camera.bottom_row_first ? -row : row);
    track.t_s.push_back(seen.frame_t_s[point.sighting.frame] + delay_s);
    track.x_m.push_back(axis.x_of(point.place));
    track.sightings.push_back(point.sighting);
  }
  const std::size_t lost = seen.marker.sightings.size() - points.size();
  if (lost > 0) {
    track.notes.push_back(fmt::format("{} sightings lie where the lens model has no ray and are left out", lost));
  }
  track.scale_sd_relative = restitution.relative_scale_sd();
  return track;
}

void note_axis(const MotionAxis& axis, bool has_pattern, std::vector<std::string>& notes) {
  if (has_pattern && std::abs(axis.angle_to_x_rad()) > kSlantedRad) {
    notes.push_back(fmt::format("the line of motion makes {:.0f} degrees with the pattern's X axis",
                                axis.angle_to_x_rad() * 180.0 / std::numbers::pi));
  }
}

}  // namespace

PictureResults tracks_of(const Experiment& experiment, int jobs, const base::Progress& progress,
                         const FrameOpener& open, bool look_at_scene, const SeenPattern* seen_pattern) {
  PictureResults results;
  results.tracks.resize(experiment.clips.size());
  results.fits.resize(experiment.clips.size());
  std::vector<std::size_t> pictures;
  for (std::size_t i = 0; i < experiment.clips.size(); ++i) {
    const ClipSetup& clip = experiment.clips[i];
    if (clip.file.empty()) {
      results.tracks[i] = read_track_csv(clip.track, downhill_of(experiment, clip.group), clip.column);
    } else {
      pictures.push_back(i);
    }
  }
  if (pictures.empty()) return results;

  progress("calibration", 0.0);
  const CameraAndPlanes setting = camera_and_planes_of(experiment, jobs, seen_pattern);
  progress("calibration", 1.0);
  std::vector<SeenClip> seen(experiment.clips.size());
  FrameCounter counter(progress, pictures.size());
  base::for_each_parallel(pictures.size(), jobs, [&](std::size_t k) {
    seen[pictures[k]] = look_at(experiment, experiment.clips[pictures[k]], setting, open, look_at_scene, counter);
  });

  for (const auto& [name, restitution] : setting.restitutions) {
    std::vector<std::vector<PlanePoint>> points(experiment.clips.size());
    std::vector<cv::Point2d> all;
    for (const std::size_t i : pictures) {
      if (experiment.clips[i].group != name) continue;
      points[i] = restituted(seen[i], restitution);
      for (const PlanePoint& point : points[i]) all.push_back(point.place);
    }
    const int downhill = downhill_of(experiment, name);
    // A marker that rests leaves noise only, which has no direction.
    cv::Point2d low(1e300, 1e300), high(-1e300, -1e300);
    for (const cv::Point2d& place : all) {
      low = {std::min(low.x, place.x), std::min(low.y, place.y)};
      high = {std::max(high.x, place.x), std::max(high.y, place.y)};
    }
    const bool moves = !all.empty() && cv::norm(high - low) > 0.5 * experiment.marker->diameter_m;
    const MotionAxis axis = moves ? MotionAxis::through(all, downhill) : MotionAxis::along_x(downhill);
    const std::vector<ModeAxis> modes = mode_axes(restitution, axis, all, downhill);
    const auto camera_modes = static_cast<std::size_t>(
        std::count_if(modes.begin(), modes.end(), [](const ModeAxis& mode) { return mode.mode.of_camera; }));
    results.modes = std::max(results.modes, camera_modes);
    for (const std::size_t i : pictures) {
      if (experiment.clips[i].group != name) continue;
      results.tracks[i] = track_from(seen[i], points[i], axis, *experiment.camera, restitution);
      std::vector<cv::Point2d> places;
      for (const PlanePoint& point : points[i]) places.push_back(point.place);
      std::vector<std::vector<double>>& shared = results.tracks[i].shared_m;
      for (const ModeAxis& mode : modes) {
        if (shared.size() == camera_modes) shared.resize(results.modes);  // the groups before have their own
        shared.push_back(mode.displacement(restitution, axis, places));
      }
      note_axis(axis, experiment.calibration.has_value(), results.tracks[i].notes);
      if (experiment.scale && experiment.scale->px_per_m_sd == 0.0) {
        results.tracks[i].notes.emplace_back("the scale is taken as exact (px_per_m_sd is 0 or not given)");
      }
    }
    const GroupSetup* group = group_of(experiment, name);
    const std::optional<PlumbSetup>& plumb = group != nullptr && group->plumb ? group->plumb : experiment.plumb;
    if (plumb) results.plumbs.push_back({name, plumb_angle(*plumb, restitution, axis, setting.size, modes)});
    results.modes += modes.size() - camera_modes;
  }
  for (const std::size_t i : pictures) results.fits[i] = std::move(seen[i].marker.fits);
  results.calibration = setting.calibration;
  return results;
}

}  // namespace glidelab::core
