#include "core/analysis/clip_to_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "core/analysis/seen_clip.h"
#include "core/pictures/camera/camera_and_planes.h"
#include "core/pictures/camera/mode_axis.h"
#include "core/pictures/camera/motion_axis.h"
#include "core/pictures/camera/plumb.h"
#include "core/track/track_csv.h"

namespace glidelab::core {
namespace {

constexpr double kSlantedRad = 15.0 * std::numbers::pi / 180.0;  // "X lies along the track to within a few degrees"
constexpr double kLeastPath = 0.5;                               // marker diameters from end to end

int downhill_of(const Experiment& experiment, const std::string& name) {
  const GroupSetup* group = group_of(experiment, name);
  return group != nullptr && group->downhill ? *group->downhill : experiment.track.downhill;
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

/// The line along which the group's marker moves; a marker that rests leaves noise only, which has no direction.
MotionAxis axis_through(const std::vector<cv::Point2d>& places, double diameter_m, int downhill) {
  cv::Point2d low(1e300, 1e300), high(-1e300, -1e300);
  for (const cv::Point2d& place : places) {
    low = {std::min(low.x, place.x), std::min(low.y, place.y)};
    high = {std::max(high.x, place.x), std::max(high.y, place.y)};
  }
  const bool moves = !places.empty() && cv::norm(high - low) > kLeastPath * diameter_m;
  return moves ? MotionAxis::through(places, downhill) : MotionAxis::along_x(downhill);
}

/// Tracks of the clips of one group, which share the plane of motion and its line.
class GroupTracks {
 public:
  GroupTracks(const Experiment& experiment, const CameraAndPlanes& setting, std::string name,
              const std::vector<SeenClip>& seen)
      : experiment_(experiment),
        setting_(setting),
        name_(std::move(name)),
        restitution_(setting.restitutions.at(name_)),
        downhill_(downhill_of(experiment, name_)),
        seen_(seen),
        points_(seen.size()) {}

  void add_to(PictureResults& results) {
    std::vector<cv::Point2d> all;
    for (const std::size_t i : clips()) {
      points_[i] = restituted(seen_[i], restitution_);
      for (const PlanePoint& point : points_[i]) all.push_back(point.place);
    }
    const MotionAxis axis = axis_through(all, experiment_.marker->diameter_m, downhill_);
    const std::vector<ModeAxis> modes = mode_axes(restitution_, axis, all, downhill_);
    const auto of_camera = static_cast<std::size_t>(
        std::count_if(modes.begin(), modes.end(), [](const ModeAxis& mode) { return mode.mode.of_camera; }));
    results.modes = std::max(results.modes, of_camera);
    for (const std::size_t i : clips()) {
      results.tracks[i] = track_from(seen_[i], points_[i], axis, *experiment_.camera, restitution_);
      add_shared(axis, modes, of_camera, points_[i], results.modes, results.tracks[i]);
      add_notes(axis, results.tracks[i].notes);
    }
    const GroupSetup* group = group_of(experiment_, name_);
    const std::optional<PlumbSetup>& plumb = group != nullptr && group->plumb ? group->plumb : experiment_.plumb;
    if (plumb) results.plumbs.push_back({name_, plumb_angle(*plumb, restitution_, axis, setting_.size, modes)});
    results.modes += modes.size() - of_camera;
  }

 private:
  /// Of the group, made of pictures.
  std::vector<std::size_t> clips() const {
    std::vector<std::size_t> of_group;
    for (std::size_t i = 0; i < experiment_.clips.size(); ++i) {
      if (!experiment_.clips[i].file.empty() && experiment_.clips[i].group == name_) of_group.push_back(i);
    }
    return of_group;
  }

  /// What the modes do to the track: the camera's come first, then, behind those of the groups before, this plane's
  /// own.
  void add_shared(const MotionAxis& axis, const std::vector<ModeAxis>& modes, std::size_t of_camera,
                  const std::vector<PlanePoint>& points, std::size_t modes_before, TrackData& track) const {
    std::vector<cv::Point2d> places;
    for (const PlanePoint& point : points) places.push_back(point.place);
    for (const ModeAxis& mode : modes) {
      if (track.shared_m.size() == of_camera) track.shared_m.resize(modes_before);
      track.shared_m.push_back(mode.displacement(restitution_, axis, places));
    }
  }

  void add_notes(const MotionAxis& axis, std::vector<std::string>& notes) const {
    note_axis(axis, experiment_.calibration.has_value(), notes);
    if (experiment_.scale && experiment_.scale->px_per_m_sd == 0.0) {
      notes.emplace_back("the scale is taken as exact (px_per_m_sd is 0 or not given)");
    }
  }

  const Experiment& experiment_;
  const CameraAndPlanes& setting_;
  std::string name_;
  const Restitution& restitution_;
  int downhill_;
  const std::vector<SeenClip>& seen_;
  std::vector<std::vector<PlanePoint>> points_;  ///< of each clip of the group
};

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
    seen[pictures[k]] = see_clip(experiment, experiment.clips[pictures[k]], setting, open, look_at_scene, counter);
  });

  for (const auto& [name, restitution] : setting.restitutions) {
    GroupTracks(experiment, setting, name, seen).add_to(results);
  }
  for (const std::size_t i : pictures) results.fits[i] = std::move(seen[i].marker.fits);
  results.calibration = setting.calibration;
  return results;
}

}  // namespace glidelab::core
