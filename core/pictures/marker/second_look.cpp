#include "core/pictures/marker/second_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/math/quantile.h"
#include "core/pictures/marker/sphere/lit_sphere.h"
#include "core/pictures/marker/sphere/sphere_window.h"

namespace glidelab::core {
namespace {

constexpr double kDiscResidual = 0.04;  // relative to the amplitude: more than noise leaves of a disc in usual light
constexpr std::size_t kFewLost = 3;     // frames without a marker at either end
constexpr std::size_t kSampled = 24;    // frames from which the common quantities are found
constexpr double kFewestDirections = 1.0 / 3.0;  // part of the directions with the expected background
constexpr double kFarOff = 3.0;                  // times the usual residuals: not the marker
constexpr std::size_t kFewestFits = 8;
constexpr double kWellKnownSize = 0.05, kLeastSizeSd = 1e-3;  // standard deviations of the log size
constexpr double kRoughest_px = 0.3;                          // roughness of the new path
constexpr double kLargestShare = 0.25;                        // of the residuals, relative to the contrast
constexpr double kHopelessShare = 2.0 * kLargestShare;        // of the sampled frames, before the blur is known
constexpr double kRougher = 1.3;                              // times the roughness of the first path that is allowed,
constexpr double kRougherButExplained = 2.0;                  // the same if the residuals are nearly noise,
constexpr double kRougherThanCentroid = 4.0;  // and if the first look is a centroid, which follows the light
constexpr double kExplained = 1.5;            // times the noise: such residuals are nearly noise
constexpr double kOddStray_px = 0.05,
                 kOddStrays = 4.0;  // distance from the neighbours' path: offset, and times the usual one
constexpr double kStray_px = 0.3, kStrays = 8.0;
constexpr double kLeastGain = 0.8;  // ratio of the residuals to those of the first look
constexpr double kUnusual = 1.5;    // times the usual residuals

/// The window of a frame, and its fit.
struct Look {
  std::size_t frame = 0;
  cv::Mat codes;  ///< of the window
  cv::Rect window;
  cv::Point2d expected;
  bool seen_first = false;  ///< whether the first look has a sighting in this frame
  cv::Vec3d shape;
  std::optional<SphereFit> fit = {};
};

/// The quantities that all frames share.
struct Shared {
  MarkerBody body = MarkerBody::sphere;
  Behind behind = Behind::still;
  ToneCurve tone = ToneCurve::linear;
  double blur_px = 0.1;
  double log_size = 0.0;
  double log_size_sd = 0.05;
  double usual_rms = 0.0;
  double usual_share = 0.0;  ///< of the residuals, relative to the contrast
};

class SecondLook {
 public:
  SecondLook(const TrackedMarker& first, const StillBackground& background, const ShapeAt& shape_at)
      : first_(first), still_(background), shape_at_(shape_at) {}

  std::optional<TrackedMarker> marker(const std::vector<FrameWindow>& windows) {
    if (first_.sightings.size() < kFewestFits) return std::nullopt;
    take_windows(windows);
    if (looks_.empty() || !find_shared()) return std::nullopt;
    fit_all();
    if (!is_better()) return std::nullopt;
    return tracked();
  }

 private:
  void take_windows(const std::vector<FrameWindow>& windows);
  std::optional<SphereFit> fit(const Look& look, cv::Point2d start, const Shared& shared,
                               const std::optional<SphereLight>& light) const;
  bool find_shared();
  void fit_all();
  bool is_good(const SphereFit& fit) const { return fit.rms < kFarOff * shared_.usual_rms; }
  void fit_lost();
  void drop_strays(double least_px, double times);
  void drop_disturbed();
  std::vector<PlaceInFrame> fitted_places() const;
  bool is_better() const;
  bool is_distinct() const;
  cv::Point2d light_of(const Look& look) const;
  TrackedMarker tracked() const;

  const TrackedMarker& first_;
  const StillBackground& still_;
  const ShapeAt& shape_at_;
  std::vector<Look> looks_;  ///< in order of frames
  KnownBackground background_;
  Shared shared_;
};

void SecondLook::take_windows(const std::vector<FrameWindow>& windows) {
  for (const FrameWindow& of : windows) {
    const auto shape = shape_at_(of.expected, MarkerBody::sphere);
    if (!shape) continue;
    background_.full_code = of.full_code;
    background_.region = looks_.empty() ? of.part : (background_.region | of.part);
    looks_.push_back({of.frame, of.codes, of.part, of.expected, of.seen, *shape});
  }
  if (looks_.empty()) return;
  std::vector<std::optional<std::pair<cv::Point2d, double>>> hidden(looks_.back().frame + 1);
  for (const Look& look : looks_) hidden[look.frame] = std::pair(look.expected, 2.0 * radius_of(look.shape) + 4.0);
  background_.part = still_.behind(background_.region, [&](std::size_t frame, cv::Point pixel) {
    return frame < hidden.size() && hidden[frame] &&
           cv::norm(cv::Point2d(pixel) - hidden[frame]->first) < hidden[frame]->second;
  });
}

std::optional<SphereFit> SecondLook::fit(const Look& look, cv::Point2d start, const Shared& shared,
                                         const std::optional<SphereLight>& light) const {
  SphereGuess guess;
  guess.centre = start;
  guess.log_size = shared.log_size;
  guess.log_size_sd = shared.log_size_sd;
  guess.blur_px = shared.blur_px;
  guess.tone = shared.tone;
  guess.flat = shared.body == MarkerBody::disc;
  guess.noise = background_.noise();
  guess.light = light;
  std::optional<SphereFit> found;
  // A second round, with the window around the first result.
  for (int round = 0; round < 2; ++round) {
    const auto shape = shape_at_(guess.centre, shared.body);
    if (!shape) return std::nullopt;
    guess.shape = *shape;
    const SphereWindow cut = cut_sphere_window(look.codes, look.window, background_, guess, shared.behind);
    if (cut.usable < kFewestDirections) return std::nullopt;
    found = fit_lit_sphere(cut.pixels, guess);
    if (!found) return std::nullopt;
    guess.centre = found->centre;
    guess.light = found->light;
  }
  return found;
}

constexpr std::array<std::pair<MarkerBody, ToneCurve>, 4> kChoices{{{MarkerBody::sphere, ToneCurve::linear},
                                                                    {MarkerBody::sphere, ToneCurve::srgb},
                                                                    {MarkerBody::disc, ToneCurve::linear},
                                                                    {MarkerBody::disc, ToneCurve::srgb}}};

bool SecondLook::find_shared() {
  std::vector<const Look*> seen;
  for (const Look& look : looks_) {
    if (look.seen_first) seen.push_back(&look);
  }
  std::vector<const Look*> sampled;
  const std::size_t step = std::max<std::size_t>(1, seen.size() / kSampled);
  for (std::size_t i = step / 2; i < seen.size(); i += step) sampled.push_back(seen[i]);
  std::optional<Shared> best;
  const auto attempt = [&](Shared shared, std::size_t every) {
    std::vector<double> residuals, shares, sizes;
    std::size_t tried = 0;
    for (std::size_t i = 0; i < sampled.size(); i += every) {
      ++tried;
      const auto found = fit(*sampled[i], sampled[i]->expected, shared, std::nullopt);
      if (!found) continue;
      residuals.push_back(found->rms);
      shares.push_back(found->rms / found->contrast);
      if (found->log_size_sd < kWellKnownSize) sizes.push_back(found->log_size);
    }
    if (2 * residuals.size() < tried || residuals.size() < 3) return false;
    shared.usual_rms = median_of(residuals);
    shared.usual_share = median_of(shares);
    if (best && shared.usual_rms >= best->usual_rms) return false;
    best = shared;
    if (sizes.size() < 3) return true;
    best->log_size = median_of(sizes);
    std::vector<double> off;
    for (const double size : sizes) off.push_back(std::abs(size - best->log_size));
    best->log_size_sd =
        std::max(kLeastSizeSd, kSdOverMedian * median_of(off) / std::sqrt(static_cast<double>(off.size())));
    return true;
  };
  for (const Behind behind : {Behind::still, Behind::moving}) {
    if (best) break;  // the background of other frames is known better than the surroundings
    for (const auto& [body, tone] : kChoices) {
      Shared shared;
      shared.behind = behind;
      shared.body = body;
      shared.tone = tone;
      shared.blur_px = 0.25;
      attempt(shared, 3);
    }
  }
  if (!best || best->usual_share > kHopelessShare) return false;
  const Shared chosen = *best;
  best.reset();
  for (const double blur : {0.05, 0.15, 0.3, 0.5, 0.8, 1.2}) {
    Shared shared;
    shared.behind = chosen.behind;
    shared.body = chosen.body;
    shared.tone = chosen.tone;
    shared.blur_px = blur;
    if (!attempt(shared, 2) && best) break;
  }
  if (!best || best->usual_share > kHopelessShare) return false;
  shared_ = *best;
  return true;
}

std::vector<PlaceInFrame> SecondLook::fitted_places() const {
  std::vector<PlaceInFrame> places;
  for (const Look& look : looks_) {
    if (look.fit) places.push_back({look.frame, look.fit->centre});
  }
  return places;
}

void SecondLook::fit_all() {
  for (Look& look : looks_) {
    const auto found = fit(look, look.expected, shared_, std::nullopt);
    if (found && is_good(*found)) look.fit = found;
  }
  drop_strays(kOddStray_px, kOddStrays);  // to be fitted again from their neighbours
  fit_lost();
  drop_strays(kStray_px, kStrays);
  drop_disturbed();
}

/// Fits the lost frames outwards from their fitted neighbours.
void SecondLook::fit_lost() {
  for (bool any = true; any;) {
    any = false;
    std::vector<PlaceInFrame> places = fitted_places();
    if (places.size() < kFewestFits) return;
    for (int direction = 0; direction < 2; ++direction) {
      for (std::size_t k = 0; k < looks_.size(); ++k) {
        const std::size_t i = direction == 0 ? k : looks_.size() - 1 - k;
        Look& look = looks_[i];
        if (look.fit) continue;
        const bool before = i > 0 && looks_[i - 1].fit, after = i + 1 < looks_.size() && looks_[i + 1].fit;
        if (!before && !after) continue;
        const auto expected = place_by_neighbours(places, look.frame, true);
        if (!expected) continue;
        const SphereLight light = before ? looks_[i - 1].fit->light : looks_[i + 1].fit->light;
        const auto found = fit(look, *expected, shared_, light);
        if (!found || !is_good(*found)) continue;
        look.fit = found;
        places.insert(
            std::lower_bound(places.begin(), places.end(), look.frame,
                             [](const PlaceInFrame& place, std::size_t frame) { return place.frame < frame; }),
            {look.frame, found->centre});
        any = true;
      }
    }
  }
}

/// Drops fits that lie far off the path of their neighbours.
void SecondLook::drop_strays(double least_px, double times) {
  const std::vector<PlaceInFrame> places = fitted_places();
  std::vector<std::pair<Look*, double>> off;
  std::vector<double> distances;
  for (Look& look : looks_) {
    if (!look.fit) continue;
    const auto expected = place_by_neighbours(places, look.frame, true);
    if (!expected) continue;
    off.emplace_back(&look, cv::norm(*expected - look.fit->centre));
    distances.push_back(off.back().second);
  }
  if (distances.empty()) return;
  const double limit = least_px + times * median_of(distances);
  for (const auto& [look, distance] : off) {
    if (distance > limit) look->fit.reset();
  }
}

/// Without fits that lie off the course of their neighbours and whose residuals are not the usual ones: something thin
/// before the marker.
void SecondLook::drop_disturbed() {
  const std::vector<double> off = off_course(fitted_places());
  std::size_t k = 0;
  for (Look& look : looks_) {
    if (look.fit && off[k++] > kOffCourse && look.fit->rms > kUnusual * shared_.usual_rms) look.fit.reset();
  }
}

bool SecondLook::is_better() const {
  std::vector<double> ours, theirs;
  std::size_t found = 0;
  for (const Look& look : looks_) {
    if (look.fit) ++found;
  }
  for (std::size_t i = 0; i < first_.sightings.size(); ++i) {
    const auto look = std::lower_bound(looks_.begin(), looks_.end(), first_.sightings[i].frame,
                                       [](const Look& a, std::size_t frame) { return a.frame < frame; });
    if (look == looks_.end() || look->frame != first_.sightings[i].frame || !look->fit) continue;
    ours.push_back(look->fit->rms * background_.full_code);
    theirs.push_back(first_.fits[i].rms);
  }
  if (found < kFewestFits || found < first_.sightings.size() || ours.size() < kFewestFits) return false;
  Places our_places, their_places;
  for (const MarkerSighting& sighting : first_.sightings) their_places[sighting.frame] = {sighting.u_px, sighting.v_px};
  for (const Look& look : looks_) {
    if (look.fit && their_places.contains(look.frame)) our_places[look.frame] = look.fit->centre;
  }
  const auto our_roughness = roughness_of(our_places), their_roughness = roughness_of(their_places);
  if (!our_roughness || *our_roughness > kRoughest_px || !is_distinct()) return false;
  const double usual = median_of(theirs), our_usual = median_of(ours);
  const bool is_centroid = usual == 0.0;
  const bool explained = our_usual < kExplained * background_.noise() * background_.full_code;
  const double rougher = is_centroid ? kRougherThanCentroid : explained ? kRougherButExplained : kRougher;
  if (their_roughness && *our_roughness > rougher * *their_roughness) return false;
  return is_centroid || found > first_.sightings.size() || our_usual < kLeastGain * usual;
}

/// Whether the residuals are small compared with the contrast.
bool SecondLook::is_distinct() const {
  std::vector<double> shares;
  for (const Look& look : looks_) {
    if (look.fit) shares.push_back(look.fit->rms / look.fit->contrast);
  }
  return median_of(shares) < kLargestShare;
}

/// The centroid, less the centre, of what differs from the background within the outline.
cv::Point2d SecondLook::light_of(const Look& look) const {
  SphereGuess guess;
  guess.centre = look.fit->centre;
  guess.shape = shape_at_(guess.centre, shared_.body).value_or(look.shape);
  guess.log_size = look.fit->log_size;
  guess.tone = shared_.tone;
  const double radius = radius_of(guess.shape) * std::exp(guess.log_size);
  cv::Point2d first;
  double all = 0.0;
  for (const SpherePixel& pixel :
       cut_sphere_window(look.codes, look.window, background_, guess, shared_.behind).pixels) {
    const cv::Point2d off = cv::Point2d(pixel.u, pixel.v) - guess.centre;
    if (cv::norm(off) > radius) continue;
    const double differs = std::abs(pixel.code - code_of_light(guess.tone, pixel.behind));
    all += differs;
    first += differs * off;
  }
  return all > 0.0 ? first / all : first;
}

TrackedMarker SecondLook::tracked() const {
  TrackedMarker tracked;
  Places places;
  for (const Look& look : looks_) {
    if (look.fit) places[look.frame] = look.fit->centre;
  }
  // Errors that are correlated over pixels (those of the model) are not in the fit's covariance. Differences along the
  // path show them.
  const double jitter = roughness_of(places).value_or(0.0);
  for (const Look& look : looks_) {
    if (!look.fit) continue;
    const SphereFit& fit = *look.fit;
    const auto shape = shape_at_(fit.centre, shared_.body).value_or(look.shape) * std::exp(-fit.log_size);
    MarkerFit marker;
    marker.centre = fit.centre;
    marker.sd_px = std::max(fit.sd_px, jitter);
    marker.shape = shape;
    marker.radius_px = radius_of(shape);
    const double mean = 0.5 * (shape[0] + shape[2]), spread = std::hypot(0.5 * (shape[0] - shape[2]), shape[1]);
    marker.elongation = (mean + spread) / std::max(mean - spread, 1e-9);
    marker.blur_px = shared_.blur_px;
    marker.rms = fit.rms * background_.full_code;
    const cv::Point at(static_cast<int>(std::lround(fit.centre.x)) - background_.region.x,
                       static_cast<int>(std::lround(fit.centre.y)) - background_.region.y);
    marker.background = background_.part.codes.at<float>(at.y, at.x);
    const double light = fit.light.ambient + std::max(0.0, fit.light.lamp[2]);
    marker.amplitude = std::abs(background_.full_code * code_of_light(shared_.tone, light) - marker.background);
    const double determinant = shape[0] * shape[2] - shape[1] * shape[1];
    const double a = shape[2] / determinant, b = -shape[1] / determinant, c = shape[0] / determinant;
    marker.moments = cv::Vec3d(a * a + b * b, b * (a + c), b * b + c * c) * 0.25;
    marker.light_px = light_of(look);
    tracked.sightings.push_back({look.frame, fit.centre.x, fit.centre.y, marker.sd_px, marker.radius_px});
    tracked.fits.push_back(marker);
  }
  tracked.body = shared_.body;
  tracked.notes.emplace_back(MarkerFittedAgain{shared_.body == MarkerBody::sphere, shared_.behind == Behind::still,
                                               tracked.sightings.size(), first_.sightings.size()});
  return tracked;
}

}  // namespace

bool is_worth_a_second_look(const TrackedMarker& first, std::size_t frames) {
  if (first.sightings.size() < kFewestFits) return false;
  const std::size_t from = first.sightings.front().frame, to = first.sightings.back().frame;
  const std::size_t missing = to - from + 1 - first.sightings.size();
  if (missing > first.left_out || from > kFewLost || to + 1 + kFewLost < frames) return true;
  std::vector<double> residuals;
  for (const MarkerFit& fit : first.fits) residuals.push_back(fit.rms / fit.amplitude);
  return median_of(residuals) > kDiscResidual;
}

bool is_steady(const TrackedMarker& marker) {
  constexpr double kRadii = 0.5;
  std::vector<PlaceInFrame> places;
  for (const MarkerSighting& sighting : marker.sightings)
    places.push_back({sighting.frame, {sighting.u_px, sighting.v_px}});
  if (places.size() < kFewestFits) return true;
  std::vector<double> off;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto expected = place_by_neighbours(places, places[i].frame, true);
    if (expected) off.push_back(cv::norm(*expected - places[i].at) / std::max(marker.sightings[i].radius_px, 1.0));
  }
  return off.empty() || median_of(std::move(off)) < kRadii;
}

StillBackground background_of(const ClipAgain& clip) {
  StillBackground background(clip.frames);
  const auto source = clip.open();
  while (const auto frame = source->next()) background.add(frame->grey, frame->index);
  return background;
}

std::optional<TrackedMarker> look_again(const TrackedMarker& first, const std::vector<FrameWindow>& windows,
                                        const StillBackground& background, const ShapeAt& shape_at) {
  return SecondLook(first, background, shape_at).marker(windows);
}

}  // namespace glidelab::core
