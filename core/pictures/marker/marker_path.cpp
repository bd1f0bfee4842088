#include "core/pictures/marker/marker_path.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "base/math/dense.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kLongestBounceFrames = 30.0;   // frames over which a bounce widens the search
constexpr std::size_t kSightingsAveraged = 20;  // sightings over which a path's size and brightness are averaged
constexpr std::size_t kSightingsForSpeed = 4;   // sightings from which a path's speed is taken
constexpr std::size_t kSightingsForSize = 50;   // sightings from which a path's size is taken
constexpr double kBounce = 2.2;                 // times its speed: how far off a bounce takes an object, with a margin

/// Whether a later path continues an earlier one. The object may have bounced while it was hidden.
bool fits_on(const MarkerPath& early, const MarkerPath& late) {
  if (early.seen.back().frame >= late.seen.front().frame) return false;
  const double gap = frames_between(early.seen.back().frame, late.seen.front().frame);
  const double speed = cv::norm(early.velocity());
  const double off = cv::norm(early.predict(late.seen.front().frame) - late.seen.front().fit.centre);
  return off < 3.0 * early.radius_px + kBounce * speed * std::min(gap, kLongestBounceFrames) &&
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
  // Perspective changes size and brightness slowly, so a single frame counts little.
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

namespace {

/// The speed of an object, in pixels per frame, by the median of the slopes between each two of its sightings. Neither
/// their noise nor one of another object matters much. Empty for fewer than five.
std::optional<double> median_speed(std::span<const MarkerSeen> seen) {
  constexpr std::size_t kFewest = 5;
  if (seen.size() < kFewest) return std::nullopt;
  std::vector<double> along_u, along_v;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t k = i + 1; k < seen.size(); ++k) {
      const cv::Point2d slope =
          (seen[k].fit.centre - seen[i].fit.centre) / frames_between(seen[i].frame, seen[k].frame);
      along_u.push_back(slope.x);
      along_v.push_back(slope.y);
    }
  }
  return std::hypot(median_of(std::move(along_u)), median_of(std::move(along_v)));
}

}  // namespace

double steady_travel(const MarkerPath& path) {
  constexpr std::size_t kBeside = 6;  // sightings on either side of a step that tell the speed
  const std::span<const MarkerSeen> seen(path.seen);
  double travel = 0.0;
  std::size_t first = 0;
  for (std::size_t next = 1; next < seen.size(); ++next) {
    const auto before = median_speed(seen.subspan(next - std::min(next, kBeside), std::min(next, kBeside)));
    const auto after = median_speed(seen.subspan(next, std::min(kBeside, seen.size() - next)));
    const MarkerSeen &from = seen[next - 1], &to = seen[next];
    const double explained =
        kBounce * std::max(before.value_or(0.0), after.value_or(0.0)) * frames_between(from.frame, to.frame);
    const bool jumps =
        (before || after) && cv::norm(to.fit.centre - from.fit.centre) > least_travel(path.radius_px) + explained;
    if (jumps) first = next;
    travel = std::max(travel, cv::norm(to.fit.centre - seen[first].fit.centre));
  }
  return travel;
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

std::optional<cv::Point2d> place_by_neighbours(const std::vector<PlaceInFrame>& places, std::size_t frame,
                                               bool without_itself) {
  constexpr std::size_t kNeighbours = 5;   // on either side
  constexpr double kFarthestAhead = 30.0;  // frames
  const auto after =
      std::lower_bound(places.begin(), places.end(), frame,
                       [](const PlaceInFrame& place, std::size_t wanted) { return place.frame < wanted; });
  std::vector<PlaceInFrame> near;
  const auto before_count = static_cast<std::size_t>(after - places.begin());
  auto next = after;
  if (next != places.end() && next->frame == frame) {
    if (!without_itself) return next->at;
    ++next;
  }
  const auto after_count = static_cast<std::size_t>(places.end() - next);
  const std::size_t want = 2 * kNeighbours;
  std::size_t take_before = std::min(before_count, kNeighbours), take_after = std::min(after_count, kNeighbours);
  take_before = std::min(before_count, want - take_after);
  take_after = std::min(after_count, want - take_before);
  near.insert(near.end(), after - static_cast<std::ptrdiff_t>(take_before), after);
  near.insert(near.end(), next, next + static_cast<std::ptrdiff_t>(take_after));
  if (near.size() < 3) return std::nullopt;
  const double first_off = frames_between(frame, near.front().frame),
               last_off = frames_between(frame, near.back().frame);
  if (first_off > kFarthestAhead || -last_off > kFarthestAhead) return std::nullopt;
  const double scale = std::max({1.0, std::abs(first_off), std::abs(last_off)});
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> b = Eigen::Matrix<double, 3, 2>::Zero();
  for (const PlaceInFrame& place : near) {
    const double t = frames_between(frame, place.frame) / scale;
    const Eigen::Vector3d powers(1.0, t, t * t);
    a += powers * powers.transpose();
    b += powers * Eigen::RowVector2d(place.at.x, place.at.y);
  }
  const Eigen::Matrix<double, 3, 2> found = base::solve_positive(a, b);
  if (!found.allFinite()) return std::nullopt;
  return cv::Point2d(found(0, 0), found(0, 1));
}

std::vector<double> off_course(const std::vector<PlaceInFrame>& places) {
  constexpr std::size_t kFewestBeside = 5;  // on either side: near an end the course is hardly more than extrapolated
  std::vector<double> off(places.size(), 0.0), known;
  for (std::size_t i = kFewestBeside; i + kFewestBeside < places.size(); ++i) {
    const auto expected = place_by_neighbours(places, places[i].frame, true);
    if (!expected) continue;
    off[i] = cv::norm(*expected - places[i].at);
    known.push_back(off[i]);
  }
  if (known.empty()) return off;
  const double usual = std::max(median_of(std::move(known)), 1e-9);
  for (double& distance : off) distance /= usual;
  return off;
}

namespace {

/// The standard deviation, per coordinate, of weighted sums over consecutive frames.
std::optional<double> sd_of_differences(const Places& places, std::span<const double> weights) {
  std::vector<double> squares;
  for (auto first = places.begin(); first != places.end(); ++first) {
    cv::Point2d sum;
    std::size_t k = 0;
    for (auto here = first; k < weights.size() && here != places.end() && here->first == first->first + k; ++here) {
      sum += weights[k++] * here->second;
    }
    if (k == weights.size()) squares.push_back(sum.dot(sum));
  }
  if (squares.size() < 4) return std::nullopt;
  // The sum of two squared Gaussian coordinates has the median 2 ln 2 variances; outliers do not matter.
  return std::sqrt(median_of(squares) / (2.0 * std::log(2.0)));
}

}  // namespace

Places places_of(const TrackedMarker& marker) {
  Places places;
  for (const MarkerSighting& sighting : marker.sightings) places[sighting.frame] = {sighting.u_px, sighting.v_px};
  return places;
}

std::optional<double> jitter_of(const Places& places) {
  constexpr std::array<double, 3> kSecond{1.0, -2.0, 1.0};
  return sd_of_differences(places, kSecond);
}

std::optional<double> roughness_of(const Places& places) {
  constexpr std::array<double, 5> kFourth{1.0, -4.0, 6.0, -4.0, 1.0};
  constexpr double kVariance = 70.0;  // 1 + 16 + 36 + 16 + 1
  const std::optional<double> sd = sd_of_differences(places, kFourth);
  return sd ? std::optional(*sd / std::sqrt(kVariance)) : std::nullopt;
}

namespace {

constexpr std::size_t kFewestMoving = 8;    // sightings of a path that can be the marker (fewer in a short clip)
constexpr std::size_t kFewestResting = 10;  // sightings of an object that counts as part of the scene
constexpr double kOddSize = 5.0;            // times the usual deviation of the size, and
constexpr double kOddResidual = 1.5;        // times the usual residuals: a look that is not the usual one
constexpr double kStartFrames = 5.0;        // frames around that of start_px in which a path is accepted

/// Whether two paths look and move alike and share half or more of the frames of the shorter one.
bool are_twins(const MarkerPath& one, const MarkerPath& other) {
  std::size_t common = 0;
  for (auto a = one.seen.begin(), b = other.seen.begin(); a != one.seen.end() && b != other.seen.end();) {
    if (a->frame == b->frame) ++common;
    if (a->frame <= b->frame) {
      ++a;
    } else {
      ++b;
    }
  }
  const auto alike = [](double x, double y, double factor) { return x < factor * y && y < factor * x; };
  return 2 * common >= std::min(one.seen.size(), other.seen.size()) && alike(one.radius_px, other.radius_px, 1.2) &&
         alike(one.amplitude, other.amplitude, 1.4) && alike(steady_travel(one), steady_travel(other), 1.6);
}

/// The choice of one path among those of a clip.
class Choice {
 public:
  Choice(const FollowedPaths& followed, const MarkerSetup& marker, const std::filesystem::path& clip)
      : paths_(followed.paths),
        frames_(followed.frames),
        radius_px_(followed.radius_px),
        start_frame_(followed.start_frame),
        marker_(marker),
        clip_(clip) {
    std::erase_if(paths_, [](const MarkerPath& path) { return path.seen.size() < 2; });
  }
  TrackedMarker marker() const;

 private:
  TrackedMarker undisturbed(const MarkerPath& path) const;
  bool is_place_of_another(const MarkerPath& path, const MarkerSeen& sighting) const;
  void require_motion(const TrackedMarker& tracked) const;
  std::size_t choose_path(std::vector<Note>& notes) const;
  std::size_t path_at_start() const;
  std::size_t resting_path(std::vector<Note>& notes) const;
  base::Issue issue(std::string found, std::string expected) const {
    return {clip_.string(), 0, "marker", std::move(found), std::move(expected)};
  }

  std::vector<MarkerPath> paths_;
  std::size_t frames_;
  double radius_px_;
  std::size_t start_frame_;
  const MarkerSetup& marker_;
  const std::filesystem::path& clip_;
};

/// The position of a path's object in a frame: interpolated between the sightings before and after; where it was seen
/// last, if it is at rest; or where it is seen within a few frames. Empty if it is not seen around that time.
std::optional<cv::Point2d> place_in(const MarkerPath& path, std::size_t frame) {
  const auto after = std::lower_bound(path.seen.begin(), path.seen.end(), frame,
                                      [](const MarkerSeen& seen, std::size_t wanted) { return seen.frame < wanted; });
  if (after == path.seen.begin()) {
    if (frames_between(frame, after->frame) >= kStartFrames) return {};
    return after->fit.centre;
  }
  const MarkerSeen& before = *std::prev(after);
  if (after == path.seen.end()) {
    if (!path.asleep && frames_between(before.frame, frame) >= kStartFrames) return {};
    return before.fit.centre;
  }
  const double part = frames_between(before.frame, frame) / frames_between(before.frame, after->frame);
  return before.fit.centre + part * (after->fit.centre - before.fit.centre);
}

/// The path that is nearest to start_px in the frame to which start_px refers.
std::size_t Choice::path_at_start() const {
  std::size_t best = paths_.size();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const std::optional<cv::Point2d> place = place_in(paths_[i], start_frame_);
    if (!place || paths_[i].seen.size() < kFewestMoving) continue;
    const double distance = cv::norm(*place - cv::Point2d(marker_.start_px->x, marker_.start_px->y));
    if (distance >= nearest) continue;
    nearest = distance;
    best = i;
  }
  const double allowed = farthest_from_start(radius_px_);
  if (best == paths_.size() || nearest > allowed) {
    throw NoMarker(issue(
        fmt::format("no marker near start_px = [{:.1f}, {:.1f}] in {}{}", marker_.start_px->x, marker_.start_px->y,
                    start_frame_ == 0 ? std::string("the first frames")
                                      : fmt::format("frame {}, which start_s names", start_frame_),
                    best == paths_.size() ? "" : fmt::format(" (the nearest is {:.0f} px off)", nearest)),
        fmt::format("one of about {:.1f} px radius within {:.0f} px{}", radius_px_, allowed,
                    start_frame_ == 0 ? "; for one that comes into view later, start_s in its [[clip]] says when "
                                        "it is there"
                                      : "")));
  }
  return best;
}

/// If nothing moves: the one object of the right size that is seen in at least half of the frames.
std::size_t Choice::resting_path(std::vector<Note>& notes) const {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const double ratio = paths_[i].size_ratio();
    if (2 * paths_[i].seen.size() >= frames_ && ratio > 0.75 && ratio < 1.33) candidates.push_back(i);
  }
  if (candidates.size() != 1) {
    throw NoMarker(issue(
        fmt::format("no marker: nothing of about {:.1f} px radius moves{}", radius_px_,
                    candidates.empty() ? "" : fmt::format(", and {} such objects are at rest", candidates.size())),
        "a marker of the stated diameter, brighter or darker than its surroundings (or of the stated colour), or "
        "start_px"));
  }
  notes.emplace_back(MarkerAtRest{});
  return candidates.front();
}

std::size_t Choice::choose_path(std::vector<Note>& notes) const {
  if (marker_.start_px) return path_at_start();
  const std::size_t fewest = std::min(kFewestMoving, std::max<std::size_t>(frames_ / 2, 2));
  std::vector<std::size_t> movers;
  std::vector<double> travels(paths_.size(), 0.0);
  double farthest = 0.0, brightest = 0.0, longest = 0.0;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const MarkerPath& path = paths_[i];
    if (path.seen.size() < fewest) continue;
    travels[i] = steady_travel(path);
    if (travels[i] < least_travel(path.radius_px)) continue;
    movers.push_back(i);
    farthest = std::max(farthest, travels[i]);
    brightest = std::max(brightest, path.amplitude);
    longest = std::max(longest, static_cast<double>(path.seen.size()));
  }
  if (movers.empty()) return resting_path(notes);
  // Squared deviations from a typical marker, each in units of its spread.
  const auto cost = [&](std::size_t i) {
    const MarkerPath& path = paths_[i];
    const double size = std::log(path.size_ratio()) / 0.2;
    const double travel = std::log(travels[i] / farthest) / 0.5;
    const double bright = std::log(path.amplitude / brightest) / 0.7;
    const double length = std::log(static_cast<double>(path.seen.size()) / longest) / 0.7;
    return size * size + travel * travel + bright * bright + length * length;
  };
  const std::size_t best =
      *std::min_element(movers.begin(), movers.end(), [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  const MarkerPath& marker = paths_[best];
  for (const std::size_t i : movers) {
    if (i == best) continue;
    const MarkerPath& other = paths_[i];
    if (are_twins(marker, other)) {
      const cv::Point2d a = marker.seen.front().fit.centre, b = other.seen.front().fit.centre;
      throw TwoMarkers(
          issue(fmt::format(
                    "two markers that look and move alike, at ({:.0f}, {:.0f}) px in frame {} and ({:.0f}, {:.0f}) px "
                    "in frame {}",
                    a.x, a.y, marker.seen.front().frame, b.x, b.y, other.seen.front().frame),
                "one marker, or start_px in the clip's [[clip]] (or in [marker], for all clips) to say which"));
    }
  }
  return best;
}

/// Whether an object rested at this place long before the path came by.
bool Choice::is_place_of_another(const MarkerPath& path, const MarkerSeen& sighting) const {
  return std::any_of(paths_.begin(), paths_.end(), [&](const MarkerPath& other) {
    if (&other == &path || other.seen.size() < kFewestResting || other.travel_px > 0.75 * path.radius_px) return false;
    return other.seen[kFewestResting - 1].frame < sighting.frame &&
           cv::norm(other.seen.back().fit.centre - sighting.fit.centre) < 0.5 * path.radius_px;
  });
}

/// The path without the frames in which a similar object rests at its place, or in which the marker is half hidden or
/// disturbed: its size differs from that in other frames, its residuals are larger, or it is off its neighbours' course
/// and unusual in either.
TrackedMarker Choice::undisturbed(const MarkerPath& path) const {
  TrackedMarker tracked;
  std::vector<double> sizes, residuals;
  for (const MarkerSeen& sighting : path.seen) {
    sizes.push_back(sighting.size());
    residuals.push_back(sighting.fit.rms / sighting.fit.amplitude);
  }
  const double usual_size = median_of(sizes);
  std::vector<double> deviations;
  for (const double size : sizes) deviations.push_back(std::abs(size / usual_size - 1.0));
  const double usual_deviation = median_of(deviations), usual_residual = median_of(residuals);
  const double size_limit = 0.1 + 6.0 * usual_deviation;
  const double residual_limit = 0.03 + 4.0 * usual_residual;
  std::vector<PlaceInFrame> places;
  for (const MarkerSeen& sighting : path.seen) places.push_back({sighting.frame, sighting.fit.centre});
  const std::vector<double> off = off_course(places);
  std::size_t dropped = 0;
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < path.seen.size(); ++i) {
    const MarkerFit& fit = path.seen[i].fit;
    if (is_place_of_another(path, path.seen[i])) {
      ++hidden;
      continue;
    }
    const double deviation = std::abs(sizes[i] / usual_size - 1.0);
    // Something thin before the marker changes its look little, but moves it.
    const bool is_odd = deviation > kOddSize * usual_deviation || residuals[i] > kOddResidual * usual_residual;
    if (deviation > size_limit || residuals[i] > residual_limit || (off[i] > kOffCourse && is_odd)) {
      ++dropped;
      continue;
    }
    tracked.sightings.push_back({path.seen[i].frame, fit.centre.x, fit.centre.y, fit.sd_px, fit.radius_px});
    tracked.fits.push_back(fit);
  }
  if (hidden > 0) tracked.notes.emplace_back(MarkerConcealed{MarkerConcealed::By::similar, hidden});
  if (dropped > 0) tracked.notes.emplace_back(MarkerConcealed{MarkerConcealed::By::disturbance, dropped});
  return tracked;
}

/// NoMarker if only sightings that are left out made the path one that moves: what is left is another object, at rest.
void Choice::require_motion(const TrackedMarker& tracked) const {
  MarkerPath left;
  for (std::size_t i = 0; i < tracked.fits.size(); ++i) left.push({tracked.sightings[i].frame, tracked.fits[i], 0.0});
  if (left.seen.size() >= 2 && steady_travel(left) >= least_travel(left.radius_px)) return;
  throw NoMarker(issue(fmt::format("no marker: what is followed in {} frames stays where it is but for frames in which "
                                   "something disturbs it",
                                   left.seen.size()),
                       "one thing of the stated diameter that stands out from its surroundings in every frame, or "
                       "start_px"));
}

TrackedMarker Choice::marker() const {
  std::vector<Note> notes;
  const MarkerPath& path = paths_[choose_path(notes)];
  TrackedMarker tracked = undisturbed(path);
  if (notes.empty() && !marker_.start_px) require_motion(tracked);
  tracked.method = path.method;
  tracked.notes.insert(tracked.notes.begin(), notes.begin(), notes.end());
  if (path.method == MarkerMethod::centroid) {
    Places places;
    for (const MarkerSighting& sighting : tracked.sightings) {
      places[sighting.frame] = {sighting.u_px, sighting.v_px};
    }
    // A centroid has no covariance. Its noise comes from the second differences (variance 1 + 4 + 1).
    const double sd = jitter_of(places).value_or(0.0) / std::sqrt(6.0);
    for (MarkerSighting& sighting : tracked.sightings) sighting.sd_px = sd;
    tracked.notes.emplace_back(MarkerMeasuredBy{MarkerMeasuredBy::What::centroid});
  }
  if (path.method == MarkerMethod::shaded) {
    tracked.notes.emplace_back(MarkerMeasuredBy{MarkerMeasuredBy::What::shading});
  }
  const double ratio = path.size_ratio();
  if (std::abs(std::log(ratio)) > 0.2) tracked.notes.emplace_back(MarkerOfOtherSize{ratio});
  return tracked;
}

}  // namespace

TrackedMarker choose_marker(const FollowedPaths& followed, const MarkerSetup& marker,
                            const std::filesystem::path& clip) {
  return Choice(followed, marker, clip).marker();
}

}  // namespace glidelab::core
