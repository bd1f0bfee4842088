#include "core/pictures/marker/marker_path.h"

#include <cmath>
#include <limits>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kLongestBounceFrames = 30.0;   // frames
constexpr std::size_t kSightingsAveraged = 20;  // sightings over which a path's size and brightness are averaged
constexpr std::size_t kSightingsForSpeed = 4;   // sightings that a path's speed is of
constexpr std::size_t kSightingsForSize = 50;   // of a path

/// A later path goes on where an earlier one was going; it may have bounced while it was hidden.
bool fits_on(const MarkerPath& early, const MarkerPath& late) {
  if (early.seen.back().frame >= late.seen.front().frame) return false;
  const double gap = frames_between(early.seen.back().frame, late.seen.front().frame);
  const double speed = cv::norm(early.velocity());
  const double off = cv::norm(early.predict(late.seen.front().frame) - late.seen.front().fit.centre);
  return off < 3.0 * early.radius_px + 2.2 * speed * std::min(gap, kLongestBounceFrames) &&
         early.is_like(late.radius_px, late.amplitude);
}

}  // namespace

double frames_between(std::size_t from, std::size_t to) {
  return static_cast<double>(to) - static_cast<double>(from);
}

double least_travel(double radius_px) {
  return std::max(1.5 * radius_px, 5.0);
}

cv::Point2d MarkerPath::velocity() const {
  if (seen.size() < 2) return {0.0, 0.0};
  const MarkerSeen& last = seen.back();
  const MarkerSeen& before = seen[seen.size() - std::min(seen.size(), kSightingsForSpeed)];
  return (last.fit.centre - before.fit.centre) / frames_between(before.frame, last.frame);
}

cv::Point2d MarkerPath::predict(std::size_t frame) const {
  return seen.back().fit.centre + velocity() * frames_between(seen.back().frame, frame);
}

void MarkerPath::push(const MarkerSeen& sighting) {
  // Perspective changes size and brightness slowly; a single frame counts little.
  const double weight = 1.0 / static_cast<double>(std::min(seen.size() + 1, kSightingsAveraged));
  radius_px += weight * (sighting.fit.radius_px - radius_px);
  amplitude += weight * (sighting.fit.amplitude - amplitude);
  seen.push_back(sighting);
  travel_px = std::max(travel_px, cv::norm(sighting.fit.centre - seen.front().fit.centre));
}

double MarkerPath::size_ratio() const {
  std::vector<double> ratios;
  const std::size_t step = std::max<std::size_t>(1, seen.size() / kSightingsForSize);
  for (std::size_t i = 0; i < seen.size(); i += step) {
    ratios.push_back(seen[i].size());
  }
  return median_of(ratios);
}

bool MarkerPath::is_like(double other_radius_px, double other_amplitude) const {
  const double size = other_radius_px / radius_px;
  const double brightness = other_amplitude / amplitude;
  return size > 0.7 && size < 1.4 && brightness > 0.5 && brightness < 2.0;
}

bool MarkerPath::is_like(const MarkerFit& fit) const {
  return is_like(fit.radius_px, fit.amplitude) && fit.elongation < kLargestElongation;
}

std::vector<MarkerPath> joined_pieces(std::vector<MarkerPath> paths) {
  for (;;) {
    std::size_t best_early = 0, best_late = 0;
    double best_gap = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < paths.size(); ++a) {
      for (std::size_t b = 0; b < paths.size(); ++b) {
        if (a == b || !fits_on(paths[a], paths[b])) continue;
        const double gap = frames_between(paths[a].seen.back().frame, paths[b].seen.front().frame);
        if (gap >= best_gap) continue;
        best_early = a;
        best_late = b;
        best_gap = gap;
      }
    }
    if (std::isinf(best_gap)) return paths;
    for (const MarkerSeen& sighting : paths[best_late].seen) paths[best_early].push(sighting);
    paths.erase(paths.begin() + static_cast<std::ptrdiff_t>(best_late));
  }
}

std::optional<double> jitter_of(const Places& places) {
  std::vector<double> squares;
  for (const auto& [frame, here] : places) {
    const auto before = frame == 0 ? places.end() : places.find(frame - 1);
    const auto after = places.find(frame + 1);
    if (before == places.end() || after == places.end()) continue;
    const cv::Point2d second = before->second - 2.0 * here + after->second;
    squares.push_back(second.dot(second));
  }
  if (squares.size() < 4) return std::nullopt;
  // The median of the sum of two squared Gaussian coordinates is 2 ln 2 variances; outliers do not matter.
  return std::sqrt(median_of(squares) / (2.0 * std::log(2.0)));
}

}  // namespace glidelab::core
