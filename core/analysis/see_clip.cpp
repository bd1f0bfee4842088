#include "core/analysis/see_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "base/errors.h"
#include "base/long_work.h"
#include "base/text/number_text.h"
#include "core/math/even_times.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/marker/second_look.h"
#include "core/pictures/marker/sphere/still_background.h"
#include "core/pictures/marker/template_look.h"
#include "core/pictures/scene/scene_watch.h"

namespace glidelab::core {
namespace {

// For a marker of unstated brightness: the fraction of frames, from its first to its last, in which a good marker is
// seen; and the factor by which a dark one must be seen more often than a bright one.
constexpr double kLeastSeenPart = 0.9, kLeastSeenRatio = 1.2;
constexpr double kBlurRadii = 0.5;     // standard deviation of a blur that fills the hole of a ring
constexpr double kLeastTravel = 1.5;   // radii from its first position
constexpr double kSomeRadiusPx = 5.0;  // if the camera has no ray for any requested pixel: small, but visible

bool moves(const TrackedMarker& marker) {
  return std::any_of(marker.sightings.begin(), marker.sightings.end(), [&](const MarkerSighting& sighting) {
    const MarkerSighting& first = marker.sightings.front();
    return std::hypot(sighting.u_px - first.u_px, sighting.v_px - first.v_px) > kLeastTravel * first.radius_px;
  });
}

/// Whether it is seen in most frames from the first sighting to the last, and moves.
bool well_seen(const TrackedMarker& marker) {
  if (!moves(marker)) return false;
  const std::size_t span = marker.sightings.back().frame - marker.sightings.front().frame + 1;
  return static_cast<double>(marker.sightings.size()) > kLeastSeenPart * static_cast<double>(span);
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
                     fit.slope_u, fit.slope_v, fit.light_px.x, fit.light_px.y});
  }
  return looks;
}

/// Replaces rounded time stamps by the camera's uniform times.
void put_even(SeenClip& seen) {
  std::optional<EvenTimes> even = even_times(seen.frame_t_s);
  if (!even) return;
  seen.notes.emplace_back(EvenStamps{even->tick_s, even->step_s, even->half_width_s});
  seen.frame_t_s = std::move(even->t_s);
}

/// Completes the record of a clip that was read to the end.
void finish_record(const FileFacts& facts, SceneWatch& scene, SeenClip& seen) {
  ImageRecord& record = *seen.images;
  record.width_px = seen.size.width;
  record.height_px = seen.size.height;
  record.codec = facts.codec;
  record.lossy = facts.lossy;
  record.stamps_missing = facts.stamps_missing;
  record.marker = looks_of(seen.marker, seen.frame_t_s);
  scene.finish(record);
}

/// What to look for if a disc is not found well: any object of the marker's size, whatever the shape of its lit part.
struct AnyShape {
  cv::Mat still;         ///< in the difference from this background, if it is not empty; otherwise in the grey value,
  bool dark = false;     ///< or in its inverse
  double blur_px = 0.0;  ///< standard deviation of a blur that makes one spot of a ring, or of quadrants

  Frame seen_in(const Frame& frame) const {
    Frame changed;
    changed.index = frame.index;
    changed.t_s = frame.t_s;
    if (!still.empty()) {
      cv::absdiff(frame.grey, still, changed.grey);
    } else if (dark) {
      cv::bitwise_not(frame.grey, changed.grey);
    } else {
      changed.grey = frame.grey;
    }
    if (blur_px > 0.0) cv::GaussianBlur(changed.grey, changed.grey, {}, blur_px);
    return changed;
  }
};

/// A marker larger than the image, or far smaller than a pixel, is a length in another unit: no search can find it.
void require_visible(const ClipSetup& clip, const Restitution& restitution, cv::Size size) {
  constexpr double kLeastRadiusPx = 0.25;
  const auto radius_px = restitution.marker_radius_px({0.5 * size.width, 0.5 * size.height});
  if (!radius_px || (*radius_px >= kLeastRadiusPx && 2.0 * *radius_px <= std::min(size.width, size.height))) return;
  throw base::InputError(base::Issue{
      clip.file.string(), 0, "marker",
      fmt::format("a marker of {} px across, by its stated size, in images of {} x {} px",
                  base::number_text(2.0 * *radius_px, 2), size.width, size.height),
      "a marker several pixels wide that fits into the image; diameter_m, height_m and square_m are in metres, "
      "px_per_m counts the pixels of a metre"});
}

SeenClip look_for(const MarkerSetup& marker, const Experiment& experiment, const ClipSetup& clip,
                  const CameraAndPlanes& setting, const FrameOpener& open, bool look_at_scene, FrameCounter& counter,
                  const AnyShape* any = nullptr) {
  const bool with_color = signal_kind(marker) == SignalKind::colored;
  const auto source = open(clip.file, *experiment.camera, with_color, setting.size);
  const Restitution& restitution = setting.restitutions.at(clip.group);
  // If a pixel has no ray (far outside the calibrated field), the marker has the size found at the first request.
  std::optional<double> usual_px;
  const auto radius_at = [&](cv::Point2d pixel) {
    const auto radius_px = restitution.marker_radius_px(pixel);
    if (!usual_px) usual_px = radius_px;
    return radius_px.value_or(usual_px.value_or(kSomeRadiusPx));
  };
  MarkerTracker tracker =
      any != nullptr ? MarkerTracker::of_any_shape(clip.file, marker, radius_at, clip.start_s, any->blur_px > 0.0)
                     : MarkerTracker(clip.file, marker, radius_at, clip.start_s);
  SeenClip seen;
  const double stated = static_cast<double>(std::max<std::size_t>(source->stated_frames(), 1));
  constexpr std::size_t kTellEvery = 10;
  std::optional<SceneWatch> scene;
  if (look_at_scene) {
    scene.emplace(source->facts().lossy.value_or(false));
    seen.images = std::make_shared<ImageRecord>();
  }
  while (const auto frame = look_at_scene || any != nullptr ? source->next() : source->next_in_parts()) {
    seen.size = frame->grey.size();
    if (seen.frame_t_s.empty()) require_visible(clip, restitution, seen.size);
    seen.frame_t_s.push_back(frame->t_s);
    tracker.add(any != nullptr ? any->seen_in(*frame) : *frame);
    if (scene) {
      scene->add(frame->grey, frame->t_s);
      seen.images->full_code = frame->grey.depth() == CV_8U ? 255.0 : 65535.0;
    }
    if (seen.frame_t_s.size() % kTellEvery == 0) counter.add(static_cast<double>(kTellEvery) / stated);
  }
  seen.marker = tracker.finish();
  seen.notes = source->notes();
  seen.predicted = source->facts().predicts;
  if (experiment.camera->time == TimeSource::container) put_even(seen);
  if (scene) finish_record(source->facts(), *scene, seen);
  return seen;
}

}  // namespace

void FrameCounter::add(double share) {
  double now = done_.load();
  while (!done_.compare_exchange_weak(now, now + share)) {
  }
  progress_("frames", std::min(1.0, (now + share) / static_cast<double>(clips_)));
}

namespace {

/// As a disc, bright or dark.
SeenClip see_disc(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                  const FrameOpener& open, bool look_at_scene, FrameCounter& counter) {
  const auto look = [&](const MarkerSetup& sought) {
    return look_for(sought, experiment, clip, setting, open, look_at_scene, counter);
  };
  const MarkerSetup marker = marker_in(experiment, clip);
  if (marker.color_bgr) return look(marker);
  std::optional<SeenClip> bright;
  std::optional<NoMarker> no_bright;
  try {
    bright = look(marker);
    if (well_seen(bright->marker)) return *std::move(bright);
  } catch (const NoMarker& nothing) {
    no_bright = nothing;
  }
  MarkerSetup dark = marker;
  dark.color_bgr = {0, 0, 0};
  try {
    SeenClip seen = look(dark);
    const double others = bright && moves(bright->marker) ? static_cast<double>(bright->marker.sightings.size()) : 0.0;
    if (well_seen(seen.marker) && static_cast<double>(seen.marker.sightings.size()) > kLeastSeenRatio * others) {
      seen.dark_marker = true;
      return seen;
    }
  } catch (const base::InputError&) {
    // There is no single dark marker either, so the bright one counts.
  }
  if (no_bright) throw NoMarker(*no_bright);
  return *std::move(bright);
}

/// Empty if no such object is found either.
std::optional<SeenClip> see_any_shape(const Experiment& experiment, const ClipSetup& clip,
                                      const CameraAndPlanes& setting, const FrameOpener& open, bool look_at_scene,
                                      FrameCounter& counter, const AnyShape& any) {
  try {
    return look_for(marker_in(experiment, clip), experiment, clip, setting, open, look_at_scene, counter, &any);
  } catch (const base::InputError&) {
    return std::nullopt;  // the error of the first search counts
  }
}

}  // namespace

namespace {

/// NoMarker for sightings that jump about.
SeenClip steady(SeenClip seen, const ClipSetup& clip) {
  if (is_steady(seen.marker)) return seen;
  throw NoMarker(base::Issue{clip.file.string(), 0, "marker",
                             fmt::format("no marker that can be followed: what is found in {} of {} frames jumps about",
                                         seen.marker.sightings.size(), seen.frame_t_s.size()),
                             "one thing of the stated diameter that stands out from its surroundings in every frame"});
}

}  // namespace

SeenClip see_clip(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                  const FrameOpener& open, bool look_at_scene, FrameCounter& counter, MarkerSearch search) {
  const auto disc = [&] { return see_disc(experiment, clip, setting, open, look_at_scene, counter); };
  const bool by_hue = signal_kind(*experiment.marker) == SignalKind::colored;
  if (by_hue) return disc();
  if (search == MarkerSearch::disc) return steady(disc(), clip);
  ClipAgain again;
  again.open = [&] { return open(clip.file, *experiment.camera, false, setting.size); };
  std::optional<SeenClip> seen;
  std::optional<NoMarker> none;
  try {
    seen = disc();
    again.frames = seen->frame_t_s.size();
    if (!is_worth_a_second_look(seen->marker, again.frames)) return *std::move(seen);
  } catch (const NoMarker& nothing) {
    none = nothing;
    const auto source = again.open();
    while (source->next()) ++again.frames;
  }
  const StillBackground background = background_of(again);
  const Restitution& restitution = setting.restitutions.at(clip.group);
  const ShapeAt shape_at = [&](cv::Point2d pixel, MarkerBody body) {
    return body == MarkerBody::sphere ? restitution.marker_shape(pixel) : restitution.disc_shape(pixel);
  };
  const auto better = [&](SeenClip& first) {
    auto marker = look_again(first.marker, again, background, shape_at);
    if (!marker) return false;
    first.marker = *std::move(marker);
    if (first.images) first.images->marker = looks_of(first.marker, first.frame_t_s);
    return true;
  };
  if (seen && better(*seen)) return *std::move(seen);
  if (seen && well_seen(seen->marker)) return *std::move(seen);
  const double seen_before = seen ? static_cast<double>(seen->marker.sightings.size()) : 0.0;
  const auto in_more_frames = [&](const SeenClip& found) {
    return static_cast<double>(found.marker.sightings.size()) > kLeastSeenRatio * seen_before;
  };
  // A marker that is seen in most frames, but not well, cannot be surpassed by as much.
  if (seen && static_cast<double>(again.frames) <= kLeastSeenRatio * seen_before) return steady(*std::move(seen), clip);
  std::vector<SeenClip> rough;
  for (const AnyShape& any : {AnyShape{background.median()}, AnyShape{}, AnyShape{{}, true}}) {
    auto found = see_any_shape(experiment, clip, setting, open, look_at_scene, counter, any);
    if (!found) continue;
    rough.push_back(*found);
    if (better(*found) && in_more_frames(*found)) return *std::move(found);
  }
  // Neither a disc nor a sphere: by its own look, unless it is as large as half the image.
  const cv::Point2d middle(0.5 * background.median().cols, 0.5 * background.median().rows);
  const double radius_px = restitution.marker_radius_px(middle).value_or(kSomeRadiusPx);
  if (radius_px < 0.5 * std::min(middle.x, middle.y)) {
    for (const bool dark : {false, true}) {
      const AnyShape blurred{{}, dark, kBlurRadii * radius_px};
      auto found = see_any_shape(experiment, clip, setting, open, look_at_scene, counter, blurred);
      if (found) rough.push_back(*std::move(found));
    }
    for (SeenClip& found : rough) {
      auto marker = look_by_template(found.marker, again, shape_at);
      if (!marker || !well_seen(*marker)) continue;
      found.marker = *std::move(marker);
      if (found.images) found.images->marker = looks_of(found.marker, found.frame_t_s);
      if (in_more_frames(found)) return std::move(found);
    }
  }
  if (none) throw NoMarker(*none);
  return steady(*std::move(seen), clip);
}

}  // namespace glidelab::core
