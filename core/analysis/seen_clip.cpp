#include "core/analysis/seen_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors.h"
#include "core/pictures/frames/even_times.h"
#include "core/pictures/scene/scene_watch.h"

namespace glidelab::core {
namespace {

// A marker whose brightness nobody states: of the frames from its first to its last, in how many a good one is seen;
// and in how many times as many as a bright one a dark one must be.
constexpr double kWellSeen = 0.9, kFarBetter = 1.2;
constexpr double kLeastTravel = 1.5;   // radii from its first place
constexpr double kSomeRadiusPx = 5.0;  // where the camera has no ray for any pixel that was asked for: small, but seen

bool moves(const TrackedMarker& marker) {
  return std::any_of(marker.sightings.begin(), marker.sightings.end(), [&](const MarkerSighting& sighting) {
    const MarkerSighting& first = marker.sightings.front();
    return std::hypot(sighting.u_px - first.u_px, sighting.v_px - first.v_px) > kLeastTravel * first.radius_px;
  });
}

/// In most frames from the first sighting to the last, of something that moves.
bool well_seen(const TrackedMarker& marker) {
  if (!moves(marker)) return false;
  const std::size_t span = marker.sightings.back().frame - marker.sightings.front().frame + 1;
  return static_cast<double>(marker.sightings.size()) > kWellSeen * static_cast<double>(span);
}

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
                  "{:.6g} ms (to {:.0f} parts in a million) explain them all: those times are used",
                  even->tick_s * 1e3, even->step_s * 1e3, std::ceil(even->half_width_s / even->step_s * 1e6)));
  seen.frame_t_s = std::move(even->t_s);
}

/// Completes the record of a clip that was read to its end.
void finish_record(const FileFacts& facts, SceneWatch& scene, SeenClip& seen) {
  PictureRecord& record = *seen.pictures;
  record.width_px = seen.size.width;
  record.height_px = seen.size.height;
  record.codec = facts.codec;
  record.lossy = facts.lossy;
  record.stamps_missing = facts.stamps_missing;
  record.marker = looks_of(seen.marker, seen.frame_t_s);
  scene.finish(record);
}

SeenClip look_for(const MarkerSetup& marker, const Experiment& experiment, const ClipSetup& clip,
                  const CameraAndPlanes& setting, const FrameOpener& open, bool look_at_scene, FrameCounter& counter) {
  const bool with_color = signal_kind(marker) == SignalKind::colored;
  const auto source = open(clip.file, *experiment.camera, with_color, setting.size);
  const Restitution& restitution = setting.restitutions.at(clip.group);
  // Where no ray belongs to a pixel (far outside the calibrated field) the marker is as large as where it was asked for
  // first.
  std::optional<double> usual_px;
  const auto radius_at = [&](cv::Point2d pixel) {
    const auto radius_px = restitution.marker_radius_px(pixel);
    if (!usual_px) usual_px = radius_px;
    return radius_px.value_or(usual_px.value_or(kSomeRadiusPx));
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
  if (scene) finish_record(source->facts(), *scene, seen);
  seen.notes.insert(seen.notes.end(), seen.marker.notes.begin(), seen.marker.notes.end());
  return seen;
}

}  // namespace

void FrameCounter::add(double share) {
  double now = done_.load();
  while (!done_.compare_exchange_weak(now, now + share)) {
  }
  progress_("frames", std::min(1.0, (now + share) / static_cast<double>(clips_)));
}

SeenClip see_clip(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                  const FrameOpener& open, bool look_at_scene, FrameCounter& counter) {
  const auto look = [&](const MarkerSetup& marker) {
    return look_for(marker, experiment, clip, setting, open, look_at_scene, counter);
  };
  if (experiment.marker->color_bgr) return look(*experiment.marker);
  std::optional<SeenClip> bright;
  std::optional<NoMarker> no_bright;
  try {
    bright = look(*experiment.marker);
    if (well_seen(bright->marker)) return *std::move(bright);
  } catch (const NoMarker& nothing) {
    no_bright = nothing;
  }
  MarkerSetup dark = *experiment.marker;
  dark.color_bgr = {0, 0, 0};
  try {
    SeenClip seen = look(dark);
    const double others = bright && moves(bright->marker) ? static_cast<double>(bright->marker.sightings.size()) : 0.0;
    if (well_seen(seen.marker) && static_cast<double>(seen.marker.sightings.size()) > kFarBetter * others) {
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

}  // namespace glidelab::core
