#include "core/pictures/marker/pattern/template_look.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <set>
#include <vector>

#include "core/math/quantile.h"
#include "core/math/skipped_frames.h"
#include "core/pictures/marker/pattern/marker_template.h"
#include "core/pictures/marker/sphere/sphere_window.h"

namespace glidelab::core {
namespace {

constexpr int kTurns = 8;                 // of look and positions; each halves the errors of the guesses
constexpr std::size_t kFewestSeen = 8;    // frames
constexpr int kStretches = 3;             // from which a look is taken, where that of all frames fails,
constexpr std::size_t kStretch = 24;      // and their length in frames
constexpr double kWorse = 3.0;            // times the usual residuals: another object
constexpr double kLeastOff_px = 0.3;      // from the neighbours' path,
constexpr double kTimesOff = 8.0;         // plus so many times the usual distance: another object
constexpr double kRoughestPath_px = 0.3;  // from frame to frame
constexpr double kMostResidual = 0.35;    // relative to the contrast of the look
constexpr double kLeastAtOutline = 0.2;   // of the look's edges: less is an object of another size
constexpr double kLatticeSd_px = 0.05;    // of places about a lattice of whole pixels: they move with the pixels
constexpr double kSlackRadii = 1.0, kLostSlackRadii = 3.0;  // margin of a window, if the marker was seen or lost
constexpr double kSlack_px = 6.0;

/// M^-1 q.
cv::Point2d pixels_of(const cv::Vec3d& shape, cv::Point2d q) {
  const double determinant = shape[0] * shape[2] - shape[1] * shape[1];
  return cv::Point2d(shape[2] * q.x - shape[1] * q.y, shape[0] * q.y - shape[1] * q.x) / determinant;
}

/// Whether places lie on a lattice of whole pixels although the object moves: what is matched is then a pattern of the
/// pixels (the blocks of a codec), not the object. Only places beside a step by a pixel or more count, so that an
/// object may rest; and their steps must differ, for an object may also move by one pixel in every frame.
bool is_on_lattice(const std::vector<PlaceInFrame>& places, double cv::Point2d::*axis) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const auto mean_phase = [&](const std::vector<double>& along) {
    std::complex<double> sum;
    for (const double at : along) sum += std::polar(1.0 / static_cast<double>(along.size()), kTurn * at);
    return sum;
  };
  std::vector<double> all, moving;
  for (const PlaceInFrame& place : places) all.push_back(place.at.*axis);
  const double phase = std::arg(mean_phase(all)) / kTurn;
  std::vector<double> steps;  // before each place, in whole pixels
  for (std::size_t k = 1; k < all.size(); ++k)
    steps.push_back(std::round(all[k] - phase) - std::round(all[k - 1] - phase));
  std::set<double> lengths;
  for (std::size_t k = 1; k + 1 < all.size(); ++k) {
    if (steps[k - 1] == 0.0 && steps[k] == 0.0) continue;
    moving.push_back(all[k]);
    lengths.insert({steps[k - 1], steps[k]});
  }
  if (moving.size() < kFewestSeen || lengths.size() < 2) return false;
  // About the lattice: a slow object is half a pixel from it where it steps. exp(-(2 pi sd)^2 / 2) of normal
  // deviations.
  const double together = std::real(mean_phase(moving) * std::polar(1.0, -kTurn * phase));
  return together > std::exp(-0.5 * std::pow(kTurn * kLatticeSd_px, 2));
}

class TemplateLook {
 public:
  TemplateLook(const TrackedMarker& rough, const ShapeAt& shape_at, RoughTrack kind)
      : rough_(rough), shape_at_(shape_at), kind_(kind) {}

  std::optional<TrackedMarker> marker(const std::vector<FrameWindow>& windows) {
    if (rough_.sightings.size() < kFewestSeen) return std::nullopt;
    take_windows(windows);
    const std::vector<std::optional<TemplateFit>> guesses = fits_;
    if (auto found = settled(); found || kind_ == RoughTrack::of_outline) return found;
    for (int stretch = 0; stretch < kStretches; ++stretch) {
      keep_stretch(guesses, stretch);
      if (auto found = settled(); found && has_own_centre_) return found;
    }
    return std::nullopt;
  }

 private:
  void take_windows(const std::vector<FrameWindow>& windows);
  void keep_stretch(const std::vector<std::optional<TemplateFit>>& guesses, int stretch);
  std::optional<TrackedMarker> settled();
  bool take_turn();
  bool put_at_own_centre();
  void fit_lost();
  void drop_strays();
  void put_on_clock();
  std::vector<PlaceInFrame> places() const;
  std::vector<std::optional<TemplateFit>> on_course() const;
  std::optional<TrackedMarker> tracked() const;
  std::size_t seen() const {
    return static_cast<std::size_t>(
        std::count_if(fits_.begin(), fits_.end(), [](const auto& fit) { return fit.has_value(); }));
  }
  bool is_good(const TemplateFit& fit) const { return fit.rms < kWorse * usual_rms_; }
  std::optional<TemplateFit> fit_from(std::size_t k, cv::Point2d start) const {
    TemplateWindow window = windows_[k];
    window.start = start;
    return look_->fit(window);
  }

  const TrackedMarker& rough_;
  const ShapeAt& shape_at_;
  const RoughTrack kind_;
  std::vector<std::size_t> frames_;  ///< of the windows, in order
  std::vector<std::size_t> clock_;   ///< the same with the frames that the camera lost
  std::vector<TemplateWindow> windows_;
  std::vector<std::optional<TemplateFit>> fits_;
  std::optional<MarkerTemplate> look_;
  double usual_rms_ = 0.0;
  bool has_own_centre_ = false;
};

void TemplateLook::take_windows(const std::vector<FrameWindow>& windows) {
  for (const FrameWindow& of : windows) {
    const auto shape = shape_at_(of.expected, MarkerBody::disc);
    if (!shape) continue;
    const double slack = (of.seen ? kSlackRadii : kLostSlackRadii) * radius_of(*shape) + kSlack_px;
    const int half = static_cast<int>(std::ceil(MarkerTemplate::kReach * radius_of(*shape) + slack));
    const cv::Rect part = cv::Rect(static_cast<int>(std::lround(of.expected.x)) - half,
                                   static_cast<int>(std::lround(of.expected.y)) - half, 2 * half + 1, 2 * half + 1) &
                          of.part;
    if (part.empty()) continue;
    frames_.push_back(of.frame);
    clock_.push_back(of.frame);
    windows_.push_back({of.codes(part - of.part.tl()), part.tl(), *shape, of.expected});
    fits_.emplace_back();
    if (of.seen) fits_.back() = TemplateFit{of.expected};
  }
}

/// Keeps the guesses of consecutive windows at the beginning, in the middle or at the end.
void TemplateLook::keep_stretch(const std::vector<std::optional<TemplateFit>>& guesses, int stretch) {
  const std::size_t length = std::min(kStretch, guesses.size());
  const std::size_t first = (guesses.size() - length) * static_cast<std::size_t>(stretch) / (kStretches - 1);
  for (std::size_t k = 0; k < guesses.size(); ++k)
    fits_[k] = k >= first && k < first + length ? guesses[k] : std::nullopt;
}

/// Takes all turns from the guesses that there are.
std::optional<TrackedMarker> TemplateLook::settled() {
  has_own_centre_ = false;
  for (int turn = 0; turn < kTurns; ++turn) {
    if (!take_turn()) return std::nullopt;
  }
  fit_lost();
  drop_strays();
  if (seen() < std::max(kFewestSeen, rough_.sightings.size())) return std::nullopt;
  if (kind_ == RoughTrack::of_parts && !put_at_own_centre()) return std::nullopt;
  return tracked();
}

/// Finds the look from the positions, then the positions from the look.
bool TemplateLook::take_turn() {
  look_ = MarkerTemplate::of(windows_, on_course());
  if (!look_) return false;
  std::vector<double> residuals;
  for (std::size_t k = 0; k < windows_.size(); ++k) {
    if (!fits_[k]) continue;
    fits_[k] = fit_from(k, fits_[k]->centre);
    if (fits_[k]) residuals.push_back(fits_[k]->rms);
  }
  if (residuals.size() < kFewestSeen) return false;
  usual_rms_ = median_of(std::move(residuals));
  for (std::optional<TemplateFit>& fit : fits_) {
    if (fit && !is_good(*fit)) fit.reset();
  }
  fit_lost();
  drop_strays();
  return seen() >= kFewestSeen;
}

/// Moves all places to the centre of a look that has one. The look is then taken anew, for one whose centre lies
/// between its nodes is not quite what it is after half a turn, and errs by a part of that distance.
bool TemplateLook::put_at_own_centre() {
  constexpr int kCentreRounds = 4;
  for (int round = 0; round < kCentreRounds; ++round) {
    look_ = MarkerTemplate::of(windows_, on_course());
    if (!look_) return false;
    const std::optional<cv::Point2d> centre = look_->centre_of_symmetry();
    if (!centre) return true;
    has_own_centre_ = true;
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      if (fits_[k]) fits_[k]->centre += pixels_of(windows_[k].shape, *centre);
    }
  }
  return true;
}

std::vector<PlaceInFrame> TemplateLook::places() const {
  std::vector<PlaceInFrame> places;
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    if (fits_[k]) places.push_back({clock_[k], fits_[k]->centre});
  }
  return places;
}

/// The fits with the places that the frames around them expect, where these are nearly the same. Places that err alike
/// wherever the marker lies alike in its pixels make a look that is distorted alike, from which every frame gets its
/// old place back; the course of a motion from pixel to pixel does not err with them.
std::vector<std::optional<TemplateFit>> TemplateLook::on_course() const {
  constexpr double kMostOffCourse_px = 0.3;  // farther off, it is no error of this kind
  std::vector<std::optional<TemplateFit>> fits = fits_;
  const std::vector<PlaceInFrame> all = places();
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (!fits[k]) continue;
    const auto expected = place_by_neighbours(all, clock_[k], true);
    if (expected && cv::norm(*expected - fits[k]->centre) < kMostOffCourse_px) fits[k]->centre = *expected;
  }
  return fits;
}

/// Counts the frames that the camera lost. A window without a fit has the clock of the fit before it.
void TemplateLook::put_on_clock() {
  constexpr double kLeastSum_px2 = 1e-6;
  std::vector<PlaceAtFrame> fitted;
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    if (fits_[k]) fitted.push_back({frames_[k], {fits_[k]->centre.x, fits_[k]->centre.y}});
  }
  const std::vector<std::size_t> lost = lost_before(std::move(fitted), kLeastSum_px2);
  std::size_t next = 0, before = 0;
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    if (fits_[k]) before = lost[next++];
    clock_[k] = frames_[k] + before;
  }
}

/// Fits the lost frames outwards from their fitted neighbours.
void TemplateLook::fit_lost() {
  for (bool any = true; any;) {
    any = false;
    put_on_clock();
    for (std::size_t step = 0; step < 2 * fits_.size(); ++step) {  // forwards, then backwards
      const std::size_t k = step < fits_.size() ? step : 2 * fits_.size() - 1 - step;
      const bool beside = (k > 0 && fits_[k - 1]) || (k + 1 < fits_.size() && fits_[k + 1]);
      if (fits_[k] || !beside) continue;
      const auto expected = place_by_neighbours(places(), clock_[k], true);
      if (!expected) continue;
      const auto found = fit_from(k, *expected);
      if (!found || !is_good(*found)) continue;
      fits_[k] = found;
      any = true;
    }
  }
}

void TemplateLook::drop_strays() {
  put_on_clock();
  const std::vector<PlaceInFrame> all = places();
  std::vector<std::pair<std::size_t, double>> off;
  std::vector<double> distances;
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    if (!fits_[k]) continue;
    const auto expected = place_by_neighbours(all, clock_[k], true);
    if (!expected) continue;
    off.emplace_back(k, cv::norm(*expected - fits_[k]->centre));
    distances.push_back(off.back().second);
  }
  if (distances.empty()) return;
  const double limit = kLeastOff_px + kTimesOff * median_of(distances);
  for (const auto& [k, distance] : off) {
    if (distance > limit) fits_[k].reset();
  }
}

std::optional<TrackedMarker> TemplateLook::tracked() const {
  Places by_frame;
  for (const PlaceInFrame& place : places()) by_frame[place.frame] = place.at;
  const auto roughness = roughness_of(by_frame);
  if (!roughness || *roughness > kRoughestPath_px || usual_rms_ > kMostResidual * look_->contrast())
    return std::nullopt;
  if (is_on_lattice(places(), &cv::Point2d::x) || is_on_lattice(places(), &cv::Point2d::y)) return std::nullopt;
  const bool by_outline = kind_ == RoughTrack::of_outline;
  if (!by_outline && look_->share_at_outline() < kLeastAtOutline) return std::nullopt;
  TrackedMarker tracked;
  tracked.method = MarkerMethod::centroid;
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    if (!fits_[k]) continue;
    MarkerFit marker;  // without a fitted outline
    marker.centre = fits_[k]->centre;
    marker.sd_px = std::max(fits_[k]->sd_px, *roughness);
    marker.radius_px = radius_of(windows_[k].shape);
    marker.amplitude = fits_[k]->gain * look_->contrast();
    tracked.sightings.push_back({frames_[k], marker.centre.x, marker.centre.y, marker.sd_px, marker.radius_px});
    tracked.fits.push_back(marker);
  }
  if (has_own_centre_ || by_outline) tracked.body = MarkerBody::disc;  // flat; no shading of a sphere has such a centre
  using What = MarkerMeasuredBy::What;
  tracked.notes.emplace_back(MarkerMeasuredBy{has_own_centre_ ? What::own_centre : What::own_look});
  return tracked;
}

}  // namespace

std::optional<TrackedMarker> look_by_template(const TrackedMarker& rough, const std::vector<FrameWindow>& windows,
                                              const ShapeAt& shape_at, RoughTrack kind) {
  return TemplateLook(rough, shape_at, kind).marker(windows);
}

}  // namespace glidelab::core
