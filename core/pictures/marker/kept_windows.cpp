#include "core/pictures/marker/kept_windows.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glidelab::core {
namespace {

constexpr double kSameRadii = 0.5;                  // between the centres of two fits of one object
constexpr std::size_t kFewestResponseWindows = 16;  // from which the response of the pixels is found,
constexpr std::size_t kResponsePixels = 32000;      // and about the number of their pixels

std::size_t bytes_of(const MarkerWindow& window) {
  return window.signal.values.total() * window.signal.values.elemSize();
}

}  // namespace

const KeptWindows::Kept* KeptWindows::nearest(std::size_t frame, cv::Point2d centre, double radius_px) const {
  const auto in_frame = kept_.find(frame);
  const Kept* found = nullptr;
  if (in_frame == kept_.end()) return found;
  for (const Kept& kept : in_frame->second) {
    const double off = cv::norm(kept.centre - centre);
    if (off <= kSameRadii * radius_px && (found == nullptr || off < cv::norm(found->centre - centre))) found = &kept;
  }
  return found;
}

const MarkerWindow* KeptWindows::around(std::size_t frame, cv::Point2d centre, double radius_px) const {
  const Kept* const found = nearest(frame, centre, radius_px);
  return found != nullptr ? &found->window : nullptr;
}

void KeptWindows::keep(const Signal& signal, std::size_t frame, const MarkerGuess& guess, const MarkerFit& fit) {
  const int reach = static_cast<int>(std::ceil(1.25 * guess.radius_px + 2.5)) + 1;
  const cv::Point middle(cvRound(fit.centre.x), cvRound(fit.centre.y));
  const cv::Rect box = cv::Rect(middle.x - reach, middle.y - reach, 2 * reach + 1, 2 * reach + 1) &
                       cv::Rect(0, 0, signal.values.cols, signal.values.rows);
  const Kept* const before = nearest(frame, fit.centre, fit.radius_px);
  const std::size_t bytes_before = before != nullptr ? bytes_of(before->window) : 0;
  const std::size_t bytes = bytes_ - bytes_before + static_cast<std::size_t>(box.area()) * signal.values.elemSize();
  if (bytes > most_bytes_) return;
  if (before != nullptr) {
    std::vector<Kept>& in_frame = kept_[frame];
    in_frame.erase(in_frame.begin() + (before - in_frame.data()));
  }
  bytes_ = bytes;
  signal.see(box);
  MarkerGuess again = guess;
  again.centre = fit.centre - cv::Point2d(box.tl());
  again.blur_px = fit.blur_px;
  again.shape = fit.shape;
  kept_[frame].push_back({fit.centre, {Signal{signal.values(box).clone(), {}, signal.inverse}, box.tl(), again}});
}

void KeptWindows::free_all_but(const std::vector<MarkerPath>& paths) {
  std::map<std::size_t, std::vector<Kept>> still;
  bytes_ = 0;
  for (const MarkerPath& path : paths) {
    if (path.asleep || (path.ended && path.travel_px < least_travel(path.radius_px))) continue;
    for (const MarkerSeen& seen : path.seen) {
      const Kept* const kept = nearest(seen.frame, seen.fit.centre, seen.fit.radius_px);
      if (kept == nullptr) continue;
      std::vector<Kept>& in_frame = still[seen.frame];
      const bool there = std::ranges::any_of(in_frame, [&](const Kept& one) { return one.centre == kept->centre; });
      if (there) continue;
      in_frame.push_back(*kept);
      bytes_ += bytes_of(kept->window);
    }
  }
  kept_ = std::move(still);
  free_above_ = bytes_ + (most_bytes_ - bytes_) / 2;
}

bool tells_more(const Places& corrected, const Places& by_codes) {
  const std::optional<double> before = roughness_of(by_codes), after = roughness_of(corrected);
  if (!before || !after) return false;
  const auto all = static_cast<double>(by_codes.size()), left = static_cast<double>(corrected.size());
  return left * *before * *before > all * *after * *after;
}

void correct_for_pixels(TrackedMarker& tracked, const KeptWindows& kept, bool may_be_curved) {
  if (tracked.method != MarkerMethod::uniform && tracked.method != MarkerMethod::shaded) return;
  const Surface surface = tracked.method == MarkerMethod::uniform ? Surface::uniform : Surface::shaded;
  std::vector<const MarkerWindow*> windows;
  std::size_t pixels = 0, known = 0;
  for (const MarkerSighting& sighting : tracked.sightings) {
    windows.push_back(kept.around(sighting.frame, {sighting.u_px, sighting.v_px}, sighting.radius_px));
    if (windows.back() == nullptr) continue;
    pixels += windows.back()->signal.values.total();
    ++known;
  }
  if (known < kFewestResponseWindows) return;
  const std::size_t wanted = std::max(kFewestResponseWindows, kResponsePixels * known / pixels);
  const std::size_t step = std::max<std::size_t>(1, windows.size() / wanted);
  std::vector<MarkerWindow> sampled;
  for (std::size_t i = 0; i < windows.size(); i += step) {
    if (windows[i] != nullptr) sampled.push_back(*windows[i]);
  }
  const std::optional<EdgeResponse> response = marker_response(sampled, surface, may_be_curved);
  if (!response) return;
  std::vector<std::optional<MarkerFit>> corrected;
  Places by_codes, without_response;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const MarkerWindow* const window = windows[i];
    corrected.push_back(window != nullptr ? fit_marker(*window, surface, *response) : std::nullopt);
    by_codes[tracked.sightings[i].frame] = tracked.fits[i].centre;
    if (corrected.back())
      without_response[tracked.sightings[i].frame] = corrected.back()->centre + cv::Point2d(window->corner);
  }
  const std::size_t failed = windows.size() - without_response.size();
  const bool leave_out = failed > 0 && known == windows.size() && tells_more(without_response, by_codes);
  if (failed > 0) tracked.notes.emplace_back(PixelsAnswerLeft{failed, windows.size(), leave_out});
  if (failed > 0 && !leave_out) return;
  tracked.left_out = failed;
  std::vector<MarkerSighting> sightings;
  std::vector<MarkerFit> fits;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    if (!corrected[i]) continue;
    MarkerFit fit = tracked.fits[i];
    MarkerSighting sighting = tracked.sightings[i];
    const cv::Point2d centre = without_response.at(sighting.frame);
    fit.light_px += fit.centre - centre;
    fit.centre = centre;
    fit.sd_px = corrected[i]->sd_px;
    sighting.u_px = centre.x;
    sighting.v_px = centre.y;
    sighting.sd_px = fit.sd_px;
    fits.push_back(fit);
    sightings.push_back(sighting);
  }
  tracked.fits = std::move(fits);
  tracked.sightings = std::move(sightings);
}

}  // namespace glidelab::core
