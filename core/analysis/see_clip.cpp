#include "core/analysis/see_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "base/errors.h"
#include "base/long_work.h"
#include "base/text/number_text.h"
#include "core/analysis/followed_wrongly.h"
#include "core/math/even_times.h"
#include "core/math/quantile.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/marker/pattern/framed_square.h"
#include "core/pictures/marker/pattern/moving_pattern.h"
#include "core/pictures/marker/pattern/template_look.h"
#include "core/pictures/marker/second_look.h"
#include "core/pictures/marker/sphere/still_background.h"
#include "core/pictures/scene/interlacing.h"
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

/// The looks of fits to the inverse of the codes, in codes: the amplitude of a dark marker is negative.
void turn_back(std::vector<MarkerLook>& looks, double full_code) {
  for (MarkerLook& look : looks) {
    look.amplitude = -look.amplitude;
    look.background = full_code - look.background;
    look.slope_u = -look.slope_u;
    look.slope_v = -look.slope_v;
  }
}

/// Completes the record of a clip that was read to the end. `inverse`: the marker was fitted to the inverse of the
/// codes.
void finish_record(const FileFacts& facts, bool inverse, SceneWatch& scene, SeenClip& seen) {
  ImageRecord& record = *seen.images;
  record.width_px = seen.size.width;
  record.height_px = seen.size.height;
  record.codec = facts.codec;
  record.lossy = facts.lossy;
  record.stamps_missing = facts.stamps_missing;
  record.marker = looks_of(seen.marker, seen.frame_t_s);
  if (inverse) turn_back(record.marker, record.full_code);
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

/// What a search saw in a clip, and why it is no marker.
struct Looked {
  SeenClip seen;
  std::optional<NoMarker> none = {};
  bool square_moves = false;  ///< a framed square of the stated size (framed_square.h)

  /// NoMarker if there is none.
  SeenClip marker() && {
    if (none) throw NoMarker(*none);
    return std::move(seen);
  }
};

Looked look_for(const MarkerSetup& marker, const Experiment& experiment, const ClipSetup& clip,
                const CameraAndPlanes& setting, const FrameOpener& open, bool look_at_scene, FrameCounter& counter,
                const AnyShape* any = nullptr, MarkerMethod by = MarkerMethod::undecided) {
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
  if (by != MarkerMethod::undecided) tracker.measure_by(by);
  SeenClip seen;
  const double stated = static_cast<double>(std::max<std::size_t>(source->stated_frames(), 1));
  constexpr std::size_t kTellEvery = 10;
  std::optional<SceneWatch> scene;
  if (look_at_scene) {
    scene.emplace(source->facts().lossy.value_or(false));
    seen.images = std::make_shared<ImageRecord>();
  }
  CombWatch combs;
  SquareWatch squares;
  const bool may_be_square = any == nullptr && !with_color;
  while (const auto frame = look_at_scene || any != nullptr ? source->next() : source->next_in_parts()) {
    seen.size = frame->grey.size();
    if (seen.frame_t_s.empty()) require_visible(clip, restitution, seen.size);
    seen.frame_t_s.push_back(frame->t_s);
    tracker.add(any != nullptr ? any->seen_in(*frame) : *frame);
    if (!frame->draw) combs.add(frame->grey, frame->index);
    if (may_be_square && !frame->draw) squares.add(frame->grey, frame->index, radius_at);
    if (scene) {
      scene->add(frame->grey, frame->t_s);
      seen.images->full_code = frame->grey.depth() == CV_8U ? 255.0 : 65535.0;
    }
    if (seen.frame_t_s.size() % kTellEvery == 0) counter.add(static_cast<double>(kTellEvery) / stated);
  }
  std::optional<NoMarker> none;
  try {
    seen.marker = tracker.finish();
  } catch (const NoMarker& nothing) {
    none = nothing;
  }
  seen.notes = source->notes();
  if (combs.share() > kInterlacedShare) seen.notes.emplace_back(InterlacedFilm{experiment.camera->frame_rate_hz});
  seen.predicted = source->facts().predicts;
  if (experiment.camera->time == TimeSource::container) put_even(seen);
  if (scene) seen.images->combs = combs.share();
  if (scene) finish_record(source->facts(), signal_kind(marker) == SignalKind::dark, *scene, seen);
  return {std::move(seen), std::move(none), squares.any_moves()};
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
Looked see_disc(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                const FrameOpener& open, bool look_at_scene, FrameCounter& counter, MarkerMethod by) {
  const auto look = [&](const MarkerSetup& sought) {
    return look_for(sought, experiment, clip, setting, open, look_at_scene, counter, nullptr, by);
  };
  const MarkerSetup marker = marker_in(experiment, clip);
  Looked bright = look(marker);
  if (marker.color_bgr || (!bright.none && well_seen(bright.seen.marker))) return bright;
  MarkerSetup dark = marker;
  dark.color_bgr = {0, 0, 0};
  try {
    Looked found = look(dark);
    const double others =
        !bright.none && moves(bright.seen.marker) ? static_cast<double>(bright.seen.marker.sightings.size()) : 0.0;
    if (!found.none && well_seen(found.seen.marker) &&
        static_cast<double>(found.seen.marker.sightings.size()) > kLeastSeenRatio * others) {
      found.seen.dark_marker = true;
      return found;
    }
  } catch (const base::InputError&) {
    // There is no single dark marker either, so the bright one counts.
  }
  return bright;
}

/// NoMarker for sightings that jump about.
SeenClip steady(SeenClip seen, const ClipSetup& clip) {
  if (is_steady(seen.marker)) return seen;
  throw NoMarker(base::Issue{clip.file.string(), 0, "marker",
                             fmt::format("no marker that can be followed: what is found in {} of {} frames jumps about",
                                         seen.marker.sightings.size(), seen.frame_t_s.size()),
                             "one thing of the stated diameter that stands out from its surroundings in every frame"});
}

/// The searches for a marker that is no disc, or that is not found well as one. Each reads the clip, so one that has
/// found the marker ends them.
class FurtherLooks {
 public:
  FurtherLooks(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
               const FrameOpener& open, bool look_at_scene, FrameCounter& counter)
      : experiment_(experiment),
        clip_(clip),
        setting_(setting),
        open_(open),
        look_at_scene_(look_at_scene),
        counter_(counter) {}

  /// The clip after the search for a disc.
  SeenClip after(Looked disc);

  /// The clip after the search by a hue. A hue tells the marker from everything else, but its centroid is a poor
  /// position: codecs store colours coarsely, and light from one side shifts it. So a lit body is fitted to the grey
  /// values as well, and counts if its path is steadier.
  SeenClip after_hue(SeenClip seen);

 private:
  std::optional<SeenClip> any_shape(const AnyShape& any) const;
  std::vector<FrameWindow> windows_of(const SeenClip& seen) const {
    return windows_around(seen.marker, again_, shape_at_);
  }
  std::optional<SeenClip> as_lit_body(const SeenClip& rough, const std::vector<FrameWindow>& windows,
                                      const StillBackground& background) const;
  bool as_own_look(const SeenClip& rough, const std::vector<FrameWindow>& windows);
  std::optional<SeenClip> as_framed_square(const SeenClip& disc) const;
  bool as_moving_pattern(const SeenClip& disc);
  bool in_more_frames(const SeenClip& found) const {
    return static_cast<double>(found.marker.sightings.size()) > kLeastSeenRatio * seen_before_;
  }

  const Experiment& experiment_;
  const ClipSetup& clip_;
  const CameraAndPlanes& setting_;
  const FrameOpener& open_;
  bool look_at_scene_;
  FrameCounter& counter_;
  const Restitution& restitution_ = setting_.restitutions.at(clip_.group);
  const ShapeAt shape_at_ = [this](cv::Point2d pixel, MarkerBody body) {
    return body == MarkerBody::sphere ? restitution_.marker_shape(pixel) : restitution_.disc_shape(pixel);
  };
  ClipAgain again_{[this] { return open_(clip_.file, *experiment_.camera, false, setting_.size); }, 0};
  double seen_before_ = 0.0;          ///< frames in which it was found as a disc
  std::optional<SeenClip> own_look_;  ///< found by its own look
  std::optional<NoMarker> lost_;      ///< why something that was found by its own look is not the marker
};

/// Empty if no such object is found either.
std::optional<SeenClip> FurtherLooks::any_shape(const AnyShape& any) const {
  try {
    Looked found =
        look_for(marker_in(experiment_, clip_), experiment_, clip_, setting_, open_, look_at_scene_, counter_, &any);
    if (!found.none) return std::move(found.seen);
  } catch (const base::InputError&) {
    // The error of the first search counts.
  }
  return std::nullopt;
}

/// With another marker in place of the rough one.
SeenClip with_marker(const SeenClip& rough, TrackedMarker marker) {
  SeenClip seen = rough;
  seen.marker = std::move(marker);
  if (seen.images) {
    seen.images = std::make_shared<ImageRecord>(*seen.images);
    seen.images->marker = looks_of(seen.marker, seen.frame_t_s);
  }
  return seen;
}

std::optional<SeenClip> FurtherLooks::as_lit_body(const SeenClip& rough, const std::vector<FrameWindow>& windows,
                                                  const StillBackground& background) const {
  auto marker = look_again(rough.marker, windows, background, shape_at_);
  if (!marker) return std::nullopt;
  SeenClip found = with_marker(rough, *std::move(marker));
  return not_from_start(found, marker_in(experiment_, clip_), clip_) ? std::nullopt : std::optional(std::move(found));
}

/// Keeps the first marker that is found by its own look. Whether it has a centre of its own: it is a pattern, which no
/// search for a lit body finds.
bool FurtherLooks::as_own_look(const SeenClip& rough, const std::vector<FrameWindow>& windows) {
  auto marker = look_by_template(rough.marker, windows, shape_at_);
  if (!marker || !well_seen(*marker)) return false;
  SeenClip found = with_marker(rough, *std::move(marker));
  if (!in_more_frames(found)) return false;
  if (auto lost = not_from_start(found, marker_in(experiment_, clip_), clip_)) {
    lost_ = std::move(lost);
    return false;
  }
  const bool has_own_centre = found.marker.body == MarkerBody::disc;
  if (has_own_centre || !own_look_) own_look_ = std::move(found);
  return has_own_centre;
}

/// Keeps the pattern with a centre of its own that moves. Whether there is one.
bool FurtherLooks::as_moving_pattern(const SeenClip& disc) {
  constexpr std::size_t kMostTried = 4;
  const auto radius_at = [&](cv::Point2d pixel) {
    return restitution_.marker_radius_px(pixel).value_or(kSomeRadiusPx);
  };
  const std::vector<MovingPattern> patterns = moving_patterns(again_, radius_at);
  for (std::size_t i = 0; i < std::min(patterns.size(), kMostTried); ++i) {
    const SeenClip rough = with_marker(disc, patterns[i].rough);
    if (!as_own_look(rough, windows_of(rough))) continue;
    own_look_->dark_marker = false;
    if (!marker_in(experiment_, clip_).start_px) require_no_twin(patterns, i, clip_);
    return true;
  }
  return false;
}

/// The framed square of the stated size that moves, unless a disc that moves is seen in more frames.
std::optional<SeenClip> FurtherLooks::as_framed_square(const SeenClip& disc) const {
  const std::vector<MovingPattern> squares = moving_squares(
      again_, [&](cv::Point2d pixel) { return restitution_.marker_radius_px(pixel).value_or(kSomeRadiusPx); });
  const std::size_t fewest = !disc.marker.sightings.empty() && moves(disc.marker) ? disc.marker.sightings.size() : 0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const SeenClip rough = with_marker(disc, squares[i].rough);
    auto marker = look_by_template(rough.marker, windows_of(rough), shape_at_, RoughTrack::of_outline);
    if (!marker || !well_seen(*marker) || marker->sightings.size() < fewest) continue;
    SeenClip found = with_marker(rough, *std::move(marker));
    if (not_from_start(found, marker_in(experiment_, clip_), clip_)) continue;
    found.dark_marker = false;
    if (!marker_in(experiment_, clip_).start_px) require_no_twin(squares, i, clip_);
    return found;
  }
  return std::nullopt;
}

SeenClip FurtherLooks::after_hue(SeenClip seen) {
  again_.frames = seen.frame_t_s.size();
  auto lit = as_lit_body(seen, windows_of(seen), background_of(again_));
  if (!lit) return seen;
  const auto by_grey = roughness_of(places_of(lit->marker)), by_hue = roughness_of(places_of(seen.marker));
  const bool steadier = by_grey && by_hue && *by_grey < *by_hue;
  SeenClip chosen = steadier ? *lit : seen;
  chosen.by_other_means = std::make_shared<TrackedMarker>(steadier ? std::move(seen.marker) : std::move(lit->marker));
  return chosen;
}

SeenClip FurtherLooks::after(Looked disc) {
  again_.frames = disc.seen.frame_t_s.size();
  const cv::Point2d middle(0.5 * disc.seen.size.width, 0.5 * disc.seen.size.height);
  const double radius_px = restitution_.marker_radius_px(middle).value_or(kSomeRadiusPx);
  // By its own look, unless it is as large as half the image.
  const bool may_have_look = radius_px < 0.5 * std::min(middle.x, middle.y);
  // A square with a frame is no disc, though one may be fitted to parts of its pattern.
  if (disc.square_moves && may_have_look && (disc.none || is_worth_a_second_look(disc.seen.marker, again_.frames))) {
    if (auto square = as_framed_square(disc.seen)) return *std::move(square);
  }
  // A disc at rest is hardly the marker if a pattern of its size moves.
  const bool rests = !disc.none && !moves(disc.seen.marker);
  if (rests && may_have_look && as_moving_pattern(disc.seen)) return *std::move(own_look_);
  if (!disc.none && !is_worth_a_second_look(disc.seen.marker, again_.frames)) return std::move(disc.seen);
  const StillBackground background = background_of(again_);
  if (!disc.none) {
    if (auto lit = as_lit_body(disc.seen, windows_of(disc.seen), background)) return *std::move(lit);
    seen_before_ = static_cast<double>(disc.seen.marker.sightings.size());
    // A marker that is seen in most frames, but not well, cannot be surpassed by as much.
    const bool in_most = static_cast<double>(again_.frames) <= kLeastSeenRatio * seen_before_;
    if (well_seen(disc.seen.marker)) return std::move(disc.seen);
    if (in_most) return steady(std::move(disc.seen), clip_);
  }
  const cv::Mat still = background.median();
  if (!rests && may_have_look && as_moving_pattern(disc.seen)) return *std::move(own_look_);
  for (const AnyShape& any : {AnyShape{still}, AnyShape{}, AnyShape{{}, true}}) {
    const std::optional<SeenClip> rough = any_shape(any);
    if (!rough) continue;
    const std::vector<FrameWindow> windows = windows_of(*rough);
    auto lit = as_lit_body(*rough, windows, background);
    if (lit && in_more_frames(*lit)) return *std::move(lit);
    if (may_have_look && as_own_look(*rough, windows)) return *std::move(own_look_);
  }
  for (const bool dark : {false, true}) {
    if (!may_have_look || own_look_) break;
    const std::optional<SeenClip> rough = any_shape({{}, dark, kBlurRadii * radius_px});
    if (rough) as_own_look(*rough, windows_of(*rough));
  }
  if (own_look_) return *std::move(own_look_);
  if (disc.none) throw NoMarker(lost_ ? *lost_ : *disc.none);
  return steady(std::move(disc.seen), clip_);
}

/// The variance of one position about its neighbours, times the number of positions.
double summed_variance(const TrackedMarker& marker) {
  return std::pow(roughness_of(places_of(marker)).value_or(0.0), 2) * static_cast<double>(marker.sightings.size());
}

}  // namespace

MarkerMethod measured_by(const SeenClip& clip) {
  const bool is_lit = clip.by_other_means && clip.marker.body;
  return is_lit ? clip.by_other_means->method : clip.marker.method;
}

std::optional<MarkerMethod> common_method(const std::vector<SeenClip>& clips) {
  std::map<MarkerMethod, std::size_t> frames;
  for (const SeenClip& clip : clips) {
    if (!clip.marker.sightings.empty()) frames[measured_by(clip)] += clip.marker.sightings.size();
  }
  if (frames.size() < 2) return std::nullopt;
  return std::ranges::max_element(frames, {}, [](const auto& of) { return of.second; })->first;
}

void measure_alike(std::vector<SeenClip>& clips) {
  const auto is_by_hue = [](const TrackedMarker& marker) { return !marker.body.has_value(); };
  bool all_lit = true, any_both = false;
  double by_hue = 0.0, lit = 0.0;
  for (const SeenClip& clip : clips) {
    if (clip.marker.sightings.empty()) continue;
    if (!clip.by_other_means) {
      all_lit = false;
      continue;
    }
    any_both = true;
    for (const TrackedMarker* marker : {&clip.marker, clip.by_other_means.get()})
      (is_by_hue(*marker) ? by_hue : lit) += summed_variance(*marker);
  }
  if (!any_both) return;
  const bool as_lit = all_lit && lit < by_hue;
  for (SeenClip& clip : clips) {
    if (!clip.by_other_means || is_by_hue(clip.marker) != as_lit) continue;
    auto other = std::make_shared<TrackedMarker>(*clip.by_other_means);
    clip = with_marker(clip, *other);
  }
}

SeenClip see_clip(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                  const FrameOpener& open, bool look_at_scene, FrameCounter& counter, MarkerSearch search,
                  MarkerMethod by) {
  Looked disc = see_disc(experiment, clip, setting, open, look_at_scene, counter, by);
  if (!disc.none) disc.none = not_from_start(disc.seen, marker_in(experiment, clip), clip);
  FurtherLooks further(experiment, clip, setting, open, look_at_scene, counter);
  if (signal_kind(*experiment.marker) == SignalKind::colored) {
    SeenClip seen = std::move(disc).marker();
    const bool is_centroid = seen.marker.method == MarkerMethod::centroid;
    return is_centroid && search == MarkerSearch::thorough ? further.after_hue(std::move(seen)) : seen;
  }
  if (search == MarkerSearch::disc) return steady(std::move(disc).marker(), clip);
  return further.after(std::move(disc));
}

}  // namespace glidelab::core
