#include "core/analysis/clip_to_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "base/errors.h"
#include "base/long_work.h"
#include "base/math/angles.h"
#include "core/analysis/centroid_wander.h"
#include "core/analysis/followed_wrongly.h"
#include "core/analysis/repeats_left_out.h"
#include "core/motion/codec_drag.h"
#include "core/pictures/camera/motion_axis.h"
#include "core/pictures/camera/plumb.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/marker/marker_body.h"
#include "core/track/bare_track.h"

namespace glidelab::core {

namespace {

constexpr double kSlantedRad = 15.0 * base::kRadPerDegree;  // "X lies along the track to within a few degrees"
constexpr double kAcrossRad = 80.0 * base::kRadPerDegree;   // off the axis along which downhill is stated
constexpr double kLeastPath = 0.5;                          // marker diameters from end to end

struct PlanePoint {
  MarkerSighting sighting;
  cv::Point2d place;
};

/// Whether it is a clip of images with a marker.
bool is_seen(const SeenClip& seen) {
  return !seen.frame_t_s.empty();
}

std::vector<PlanePoint> restituted(const SeenClip& seen, const Restitution& restitution) {
  std::vector<PlanePoint> points;
  for (const MarkerSighting& sighting : seen.marker.sightings) {
    const auto place = restitution.to_plane({sighting.u_px, sighting.v_px});
    if (place) points.push_back({sighting, *place});
  }
  return points;
}

/// Frames without the marker, if there are more than a few: neither before it enters nor after it leaves the image, nor
/// where another note says why.
std::optional<MarkerLost> frames_lost(const SeenClip& seen) {
  constexpr std::size_t kFew = 3;
  constexpr double kEdgeRadii =
      3.0;  // and a step of its motion: this close to the edge it comes from outside, or leaves
  const std::vector<MarkerSighting>& sightings = seen.marker.sightings;
  if (sightings.empty()) return std::nullopt;
  const auto at_edge = [&](const MarkerSighting& at, const MarkerSighting& next) {
    const double frames = std::max(1.0, std::abs(static_cast<double>(next.frame) - static_cast<double>(at.frame)));
    const double step_px = std::hypot(next.u_px - at.u_px, next.v_px - at.v_px) / frames;
    return std::min({at.u_px, at.v_px, seen.size.width - 1.0 - at.u_px, seen.size.height - 1.0 - at.v_px}) <
           kEdgeRadii * at.radius_px + step_px;
  };
  const MarkerSighting &first = sightings.front(), &last = sightings.back();
  const std::size_t beside = sightings.size() > 1 ? 1 : 0;
  MarkerLost lost;
  lost.frames = seen.frame_t_s.size();
  if (!at_edge(first, sightings[beside])) lost.before = first.frame;
  if (!at_edge(last, sightings[sightings.size() - 1 - beside])) lost.after = lost.frames - 1 - last.frame;
  lost.between = last.frame - first.frame + 1 - sightings.size();
  lost.between -= std::min(lost.between, seen.marker.left_out);
  for (const Note& note : seen.marker.notes) {
    if (const auto* const hidden = std::get_if<MarkerConcealed>(&note))
      lost.between -= std::min(lost.between, hidden->frames);
  }
  return lost.before + lost.between + lost.after > kFew ? std::optional(lost) : std::nullopt;
}

TrackData track_from(const SeenClip& seen, const std::vector<PlanePoint>& points, const MotionAxis& axis,
                     const CameraSettings& camera, const Restitution& restitution) {
  TrackData track;
  track.frame_rate_hz = camera.frame_rate_hz;
  track.frame_t_s = seen.frame_t_s;
  track.notes = seen.notes;
  track.notes.insert(track.notes.end(), seen.marker.notes.begin(), seen.marker.notes.end());
  if (const auto lost = frames_lost(seen)) track.notes.emplace_back(*lost);
  if (seen.dark_marker) track.notes.emplace_back(DarkMarker{});
  if (restitution.is_disc()) track.notes.emplace_back(DiscMarker{});
  track.images = seen.images;
  track.dark_marker = seen.dark_marker;
  for (const PlanePoint& point : points) {
    track.frame.push_back(point.sighting.frame);
    // A rolling shutter exposes the marker's row later than the image's middle row, to which the frame's time refers.
    const double row = point.sighting.v_px - 0.5 * (seen.size.height - 1);
    const double delay_s = camera.line_readout_s * (camera.bottom_row_first ? -row : row);
    track.t_s.push_back(seen.frame_t_s[point.sighting.frame] + delay_s);
    track.x_m.push_back(axis.x_of(point.place));
    track.sightings.push_back(point.sighting);
  }
  const std::size_t lost = seen.marker.sightings.size() - points.size();
  if (lost > 0) track.notes.emplace_back(NoRay{lost});
  track.scale_sd_relative = restitution.relative_scale_sd();
  return track;
}

void note_axis(const MotionAxis& axis, bool has_pattern, std::vector<Note>& notes) {
  if (has_pattern && std::abs(axis.angle_to_x_rad()) > kSlantedRad) {
    notes.emplace_back(SlantedLine{axis.angle_to_x_rad() * base::kDegreesPerRad});
  }
}

/// The line along which the group's marker moves; a marker at rest shows only noise, which has no direction.
MotionAxis axis_through(const std::vector<cv::Point2d>& places, double diameter_m, Downhill downhill) {
  cv::Point2d low(1e300, 1e300), high(-1e300, -1e300);
  for (const cv::Point2d& place : places) {
    low = {std::min(low.x, place.x), std::min(low.y, place.y)};
    high = {std::max(high.x, place.x), std::max(high.y, place.y)};
  }
  const bool moves = !places.empty() && cv::norm(high - low) > kLeastPath * diameter_m;
  return moves ? MotionAxis::through(places, downhill) : MotionAxis::along(downhill);
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
        downhill_(downhill_of(experiment, name_).value_or(Downhill::plus_x)),
        seen_(seen),
        points_(seen.size()) {}

  void add_to(ImageResults& results) {
    std::vector<cv::Point2d> all;
    if (is_lost(results)) return;
    for (const std::size_t i : clips()) {
      points_[i] = restituted(seen_[i], restitution_);
      for (const PlanePoint& point : points_[i]) all.push_back(point.place);
    }
    const MotionAxis axis = axis_through(all, experiment_.marker->diameter_m, downhill_);
    check_direction(axis);
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
    if (plumb)
      results.plumbs.push_back(
          {name_, plumb_angle(*plumb, restitution_, axis, setting_.size, modes, most_pixels_of(experiment_))});
    results.modes += modes.size() - of_camera;
  }

 private:
  /// The clips of the group in whose images the marker is seen.
  std::vector<std::size_t> clips() const {
    std::vector<std::size_t> of_group;
    for (std::size_t i = 0; i < experiment_.clips.size(); ++i) {
      if (is_seen(seen_[i]) && experiment_.clips[i].group == name_) of_group.push_back(i);
    }
    return of_group;
  }

  /// Whether the group has images, but none with the marker.
  bool is_lost(const ImageResults& results) const {
    bool any = false;
    for (std::size_t i = 0; i < experiment_.clips.size(); ++i)
      any = any || (results.without_marker[i] && experiment_.clips[i].group == name_);
    return any && clips().empty();
  }

  /// The effect of the modes on the track: the camera's first, then this plane's, after those of the previous groups.
  void add_shared(const MotionAxis& axis, const std::vector<ModeAxis>& modes, std::size_t of_camera,
                  const std::vector<PlanePoint>& points, std::size_t modes_before, TrackData& track) const {
    std::vector<cv::Point2d> places;
    for (const PlanePoint& point : points) places.push_back(point.place);
    for (const ModeAxis& mode : modes) {
      if (track.shared_m.size() == of_camera) track.shared_m.resize(modes_before);
      track.shared_m.push_back(mode.displacement(restitution_, axis, places));
    }
  }

  /// A motion across the stated axis does not tell which direction is down. (A pattern's X should lie along the track;
  /// a note says if it does not.)
  void check_direction(const MotionAxis& axis) const {
    if (!experiment_.scale || !std::isfinite(axis.line().sd_angle_rad)) return;
    const double from_x = std::abs(axis.angle_to_x_rad());
    const double off = is_along_y(downhill_) ? 0.5 * std::numbers::pi - from_x : from_x;
    if (off < kAcrossRad) return;
    const bool along_y = is_along_y(downhill_);
    throw base::InputError(base::Issue{
        experiment_.file.string(), 0, "downhill",
        fmt::format("\"{}\", while the marker of group \"{}\" moves along the image's {}, {:.0f} degrees off",
                    name_of(downhill_), name_, along_y ? "x" : "y", off * base::kDegreesPerRad),
        along_y ? "\"+X\" (to the right) or \"-X\"" : "\"+Y\" (towards the image's lower edge) or \"-Y\""});
  }

  void add_notes(const MotionAxis& axis, std::vector<Note>& notes) const {
    note_axis(axis, experiment_.calibration.has_value(), notes);
    if (experiment_.scale && experiment_.scale->px_per_m_sd == 0.0) {
      notes.emplace_back(ExactScale{});
    }
  }

  const Experiment& experiment_;
  const CameraAndPlanes& setting_;
  std::string name_;
  const Restitution& restitution_;
  Downhill downhill_;
  const std::vector<SeenClip>& seen_;
  std::vector<std::vector<PlanePoint>> points_;  ///< of each clip of the group
};

constexpr double kBeyondDoubt = 10.0;  // log evidence

/// Subtracts the drag of a predictive codec (codec_drag.h) that is stated, or beyond doubt; the rest is a shared error.
void take_off_codec_drag(const Experiment& experiment, const std::vector<SeenClip>& seen, ImageResults& results) {
  std::vector<DragTrack> tracks;
  std::vector<std::size_t> of_clip;
  bool predicts = false;
  for (std::size_t i = 0; i < experiment.clips.size(); ++i) {
    if (!is_seen(seen[i]) || !seen[i].predicted.value_or(true)) continue;
    tracks.push_back({&experiment.clips[i], &results.tracks[i]});
    of_clip.push_back(i);
    predicts = predicts || seen[i].predicted.value_or(false);
  }
  const std::optional<CodecDrag> drag = find_codec_drag(tracks, predicts);
  if (!drag || (!predicts && drag->log_evidence < kBeyondDoubt)) return;
  for (std::size_t k = 0; k < of_clip.size(); ++k) {
    TrackData& track = results.tracks[of_clip[k]];
    for (std::size_t p = 0; p < drag->drag_m[k].size(); ++p) track.x_m[p] -= drag->drag_m[k][p];
    track.shared_m.resize(results.modes);
    for (const auto& mode : drag->error_m) track.shared_m.push_back(mode[k]);
    if (drag->log_evidence < kBeyondDoubt) continue;
    track.notes.emplace_back(CodecDragSubtracted{drag->rms_px});
  }
  results.modes += drag->error_m.size();
}

/// The light's shifts of the two centroids of a clip from each other, along x (centroid_wander.h).
void add_shifts(const TrackedMarker& marker, const TrackData& track, std::vector<CentroidShift>& shifts) {
  const auto n = static_cast<double>(track.x_m.size());
  double x = 0.0, xx = 0.0;
  cv::Point2d at, slope;  // of the image over x, px/m
  for (std::size_t i = 0; i < track.x_m.size(); ++i) {
    x += track.x_m[i] / n;
    at += cv::Point2d(track.sightings[i].u_px, track.sightings[i].v_px) / n;
  }
  for (std::size_t i = 0; i < track.x_m.size(); ++i) {
    const double off_m = track.x_m[i] - x;
    xx += off_m * off_m;
    slope += off_m * (cv::Point2d(track.sightings[i].u_px, track.sightings[i].v_px) - at);
  }
  if (!(cv::norm(slope) > 0.0)) return;
  slope /= xx;
  std::map<std::size_t, cv::Point2d> light_px;
  for (std::size_t k = 0; k < marker.fits.size(); ++k) light_px[marker.sightings[k].frame] = marker.fits[k].light_px;
  for (std::size_t i = 0; i < track.x_m.size(); ++i)
    shifts.push_back({track.x_m[i], light_px[track.frame[i]].dot(slope) / slope.dot(slope)});
}

/// Adds the wander of centroids to the shared errors of a group's clips.
void add_centroid_wander(const Experiment& experiment, const std::string& group, const std::vector<SeenClip>& seen,
                         ImageResults& results) {
  std::vector<std::size_t> clips;
  std::vector<CentroidShift> shifts;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool of_group = !experiment.clips[i].file.empty() && experiment.clips[i].group == group;
    if (!of_group || seen[i].marker.method != MarkerMethod::centroid) continue;
    clips.push_back(i);
    add_shifts(seen[i].marker, results.tracks[i], shifts);
  }
  const std::optional<CentroidWander> wander = centroid_wander(shifts);
  if (!wander) return;
  for (const std::size_t i : clips) {
    TrackData& track = results.tracks[i];
    track.shared_m.resize(results.modes);
    for (std::size_t mode = 0; mode < kWanderModes; ++mode) {
      std::vector<double>& displacement = track.shared_m.emplace_back();
      for (const double x_m : track.x_m) displacement.push_back(wander->at(mode, x_m));
    }
  }
  results.modes += kWanderModes;
}

/// What the marker of all clips is: by its outlines where the fits left them free, else as which it was fitted.
std::optional<MarkerBody> body_of(const Experiment& experiment, const CameraAndPlanes& setting,
                                  const std::vector<SeenClip>& seen) {
  std::vector<OutlineSeen> outlines;
  std::size_t discs = 0, spheres = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const TrackedMarker& marker = seen[i].marker;
    if (marker.body) (marker.body == MarkerBody::disc ? discs : spheres) += marker.sightings.size();
    if (experiment.clips[i].file.empty() || marker.body) continue;
    const Restitution& restitution = setting.restitutions.at(experiment.clips[i].group);
    for (std::size_t k = 1; k < marker.fits.size(); ++k) {
      const cv::Point2d at = marker.fits[k].centre;
      const auto sphere = restitution.marker_shape(at), disc = restitution.disc_shape(at);
      const auto frames = static_cast<double>(marker.sightings[k].frame - marker.sightings[k - 1].frame);
      if (!sphere || !disc || !(marker.fits[k].blur_px > 0.0)) continue;  // a centroid has no outline
      outlines.push_back({marker.fits[k].shape, *sphere, *disc, (at - marker.fits[k - 1].centre) / frames});
    }
  }
  // With a scale alone both bodies have the same outline, and a rolling shutter shears it (marker_body.h).
  const bool tells = setting.calibration && !(experiment.camera->line_readout_s > 0.0);
  if (const auto body = tells ? body_by_outline(outlines) : std::nullopt) return body;
  if (discs == spheres) return std::nullopt;
  return discs > spheres ? MarkerBody::disc : MarkerBody::sphere;
}

/// All that x covers, with the sign of the way in which it first leaves its start by a tenth of that.
double first_way(const std::vector<double>& x_m) {
  constexpr double kLeft = 0.1;
  const auto [low, high] = std::minmax_element(x_m.begin(), x_m.end());
  const auto left = [&](double x) { return std::abs(x - x_m.front()) > kLeft * (*high - *low); };
  const auto first = std::find_if(x_m.begin(), x_m.end(), left);
  return first == x_m.end() ? 0.0 : std::copysign(*high - *low, *first - x_m.front());
}

/// The tracks of one set-up whose sign may have to be found.
struct SetUpTracks {
  std::vector<TrackData*> all, heights;
  bool only_falls = true;
  bool has_sign = false;          ///< by a stated direction of the slope, a recorded force, an inclination below 0
  bool is_launched = false;       ///< up or down, as stated
  double heights_launched = 0.0;  ///< metres of heights that begin as their launch is stated, less those against it
};

/// Makes x of falls and of heights positive downwards, one sign for each set-up. A stated direction of the slope, a
/// recorded force and an inclination below 0 have the sign of x already, and so has the launch of a fall. Heights
/// follow their launch where it is stated.
void count_downwards_by_set_up(const Experiment& experiment, std::vector<TrackData>& tracks) {
  std::map<std::string, SetUpTracks> set_ups;
  for (std::size_t i = 0; i < experiment.clips.size(); ++i) {
    const ClipSetup& clip = experiment.clips[i];
    if (!clip.file.empty()) continue;
    SetUpTracks& of = set_ups[clip.group];
    of.all.push_back(&tracks[i]);
    of.only_falls = of.only_falls && is_fall(clip.incline_rad);
    of.has_sign =
        of.has_sign || !tracks[i].force_n.empty() || downhill_of(experiment, clip.group) || clip.incline_rad < 0.0;
    const bool launched_down = clip.launched == Launched::down;
    const bool launched = launched_down || clip.launched == Launched::up;
    of.is_launched = of.is_launched || launched;
    const bool is_height = std::ranges::any_of(
        tracks[i].notes, [](const Note& note) { return std::holds_alternative<HeightTaken>(note); });
    if (!is_height) continue;
    of.heights.push_back(&tracks[i]);
    if (launched) of.heights_launched += (launched_down ? 1.0 : -1.0) * first_way(tracks[i].x_m);
  }
  for (const auto& [group, of] : set_ups) {
    if (of.has_sign) continue;
    if (of.heights_launched != 0.0) {
      if (of.heights_launched < 0.0) reverse(of.heights);
    } else {
      count_downwards(of.only_falls && !of.is_launched ? of.all : of.heights);
    }
  }
}

}  // namespace

ImageResults tracks_of(const Experiment& experiment, int jobs, const base::Progress& progress, const FrameOpener& open,
                       bool look_at_scene, const SeenPattern* seen_pattern, MarkerSearch search,
                       WithoutMarker without) {
  ImageResults results;
  results.tracks.resize(experiment.clips.size());
  results.fits.resize(experiment.clips.size());
  results.without_marker.resize(experiment.clips.size());
  std::vector<std::size_t> images;
  for (std::size_t i = 0; i < experiment.clips.size(); ++i) {
    const ClipSetup& clip = experiment.clips[i];
    if (clip.file.empty()) {
      const std::optional<Downhill> downhill = downhill_of(experiment, clip.group);
      results.tracks[i] = read_track(clip.track, downhill, clip.column,
                                     clip.speeds_alone ? SpeedsAlone::taken : SpeedsAlone::refused, clip.image_units);
      if (clip.mass_assumed && !results.tracks[i].force_n.empty()) {
        throw base::InputError(base::Issue{clip.track.string(), 0, "--mass", "none, with a recorded force (force_n)",
                                           "the moving mass in kilograms: the force accelerates it by F/m"});
      }
    } else {
      images.push_back(i);
    }
  }
  count_downwards_by_set_up(experiment, results.tracks);
  if (images.empty()) return results;

  progress("calibration", 0.0);
  CameraAndPlanes setting = camera_and_planes_of(experiment, jobs, seen_pattern, progress);
  progress("calibration", 1.0);
  std::vector<SeenClip> seen(experiment.clips.size());
  FrameCounter counter(progress, images.size());
  base::for_each_parallel(images.size(), jobs, [&](std::size_t k) {
    const std::size_t i = images[k];
    try {
      seen[i] = see_clip(experiment, experiment.clips[i], setting, open, look_at_scene, counter, search);
    } catch (const MarkerNotFound& none) {
      if (without == WithoutMarker::an_error) throw;
      results.without_marker[i] = none;
    }
  });
  if (signal_kind(*experiment.marker) == SignalKind::colored) {
    if (const std::optional<MarkerMethod> method = common_method(seen)) {
      base::for_each_parallel(images.size(), jobs, [&](std::size_t k) {
        const std::size_t i = images[k];
        if (!is_seen(seen[i]) || measured_by(seen[i]) == *method) return;
        try {
          seen[i] = see_clip(experiment, experiment.clips[i], setting, open, look_at_scene, counter, search, *method);
        } catch (const MarkerNotFound&) {
          // It is not found in that way: the clip keeps its own, and its notes tell which.
        }
      });
    }
    measure_alike(seen);
  }
  for (const std::size_t i : images) {
    if (!is_seen(seen[i])) continue;
    const std::optional<NoMarker> rough = far_rougher(seen, i, experiment.clips[i]);
    if (!rough) continue;
    if (without == WithoutMarker::an_error) throw NoMarker(*rough);
    results.without_marker[i] = *rough;
  }
  for (const std::size_t i : images) {
    if (results.without_marker[i]) seen[i] = {};
    leave_out_repeats(seen[i]);
  }
  const bool is_disc = body_of(experiment, setting, seen) == MarkerBody::disc;
  for (auto& [name, restitution] : setting.restitutions) {
    if (is_disc) restitution.take_for_disc();
  }

  for (const auto& [name, restitution] : setting.restitutions) {
    GroupTracks(experiment, setting, name, seen).add_to(results);
  }
  for (const auto& [name, restitution] : setting.restitutions) add_centroid_wander(experiment, name, seen, results);
  take_off_codec_drag(experiment, seen, results);
  for (const std::size_t i : images) results.fits[i] = std::move(seen[i].marker.fits);
  results.calibration = setting.calibration;
  return results;
}

}  // namespace glidelab::core
