// The end of MarkerTracker: how a path is measured, which pieces belong together, and which path is the marker.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.h"
#include "core/marker_track.h"
#include "core/median.h"

namespace glidelab::core {
namespace {

constexpr double kBicForShading = 10.0;     // a frame, on average: "very strong" on the usual scale
constexpr double kSmallestShadedPx = 3.0;   // below, shading and place cannot be told apart
constexpr double kDiscResidual = 0.1;       // of the amplitude; what is no disc leaves more
constexpr std::size_t kFewestMoving = 8;    // sightings of a path that counts as a marker (fewer in a shorter clip)
constexpr double kLongestBounce = 30.0;     // frames
constexpr std::size_t kFewestResting = 10;  // sightings of something that counts as part of the scene
constexpr std::size_t kStartFrames = 5;     // in which start_px is looked at

using Places = std::map<std::size_t, cv::Point2d>;

/// Standard deviation of a coordinate of the second differences of consecutive frames' places; nothing with fewer than
/// four of them.
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

bool overlaps(std::size_t common, std::size_t a, std::size_t b) {
  return 2 * common >= std::min(a, b);
}

}  // namespace

/// Uniform or shaded surface by the residuals of the windows kept; for a thing known by its hue also the centroid,
/// where it is steadier. All sightings so far are measured again in the way chosen.
void MarkerTracker::choose_method(Path& path) const {
  // First what all windows agree on: the picture's sharpness, and the marker's size, from which each fit then starts.
  std::vector<double> blurs, sizes;
  for (const Sample& sample : path.samples) {
    const auto fit = measure(sample.window, sample.guess, Method::uniform);
    if (!fit) continue;
    blurs.push_back(fit->blur_px);
    sizes.push_back(fit->radius_px / sample.guess.radius_px);
  }
  for (Sample& sample : path.samples) {
    if (blurs.empty()) break;
    sample.guess.blur_px = median_of(blurs);
    sample.guess.radius_px *= median_of(sizes);
    sample.guess.shape.reset();
  }
  std::map<Method, std::map<std::size_t, MarkerFit>> fits;
  double bic_gain = 0.0;
  std::size_t both = 0;
  for (const Sample& sample : path.samples) {
    std::vector<Method> methods{Method::uniform};
    if (sample.guess.radius_px >= kSmallestShadedPx) methods.push_back(Method::shaded);
    if (kind_ == SignalKind::colored) methods.push_back(Method::centroid);
    for (const Method method : methods) {
      auto fit = measure(sample.window, sample.guess, method);
      if (!fit) continue;
      fit->centre += cv::Point2d(sample.corner);
      fits[method][sample.frame] = *fit;
    }
    const auto uniform = fits[Method::uniform].find(sample.frame);
    const auto shaded = fits[Method::shaded].find(sample.frame);
    if (uniform == fits[Method::uniform].end() || shaded == fits[Method::shaded].end()) continue;
    bic_gain += uniform->second.bic - shaded->second.bic;
    ++both;
  }
  const auto most = [&](Method method) { return 10 * fits[method].size() >= 9 * path.samples.size(); };
  const auto jitter = [&](Method method) {
    Places places;
    for (const auto& [frame, fit] : fits[method]) places[frame] = fit.centre;
    return jitter_of(places);
  };
  Method chosen = Method::uniform;
  if (most(Method::shaded) && both > 0 && bic_gain > kBicForShading * static_cast<double>(both))
    chosen = Method::shaded;
  if (kind_ == SignalKind::colored && most(Method::centroid)) {
    std::vector<double> residuals{0.0};
    for (const auto& [frame, fit] : fits[chosen]) residuals.push_back(fit.rms / fit.amplitude);
    const auto of_fit = jitter(chosen);
    const auto of_centroid = jitter(Method::centroid);
    const bool is_disc = most(chosen) && median_of(residuals) < kDiscResidual;
    if (!is_disc || (of_fit && of_centroid && *of_fit > 1.2 * *of_centroid)) chosen = Method::centroid;
  }
  path.method = chosen;
  std::vector<Seen> kept;
  for (const Seen& sighting : path.seen) {
    const bool sampled = std::any_of(path.samples.begin(), path.samples.end(),
                                     [&](const Sample& sample) { return sample.frame == sighting.frame; });
    const auto again = fits[chosen].find(sighting.frame);
    if (again != fits[chosen].end()) {
      kept.push_back({sighting.frame, again->second, radius_at_(again->second.centre)});
    } else if (!sampled) {
      kept.push_back(sighting);  // followed back, or asleep
    }
  }
  path.samples.clear();
  if (kept.size() < 2) return;
  path.seen.clear();
  path.travel_px = 0.0;
  for (const Seen& sighting : kept) path.push(sighting);
}

/// A path that ends and one that begins later where it was going are one thing.
void MarkerTracker::join_pieces() {
  const auto fits_on = [](const Path& early, const Path& late) {
    if (early.seen.back().frame >= late.seen.front().frame) return false;
    const auto gap = static_cast<double>(late.seen.front().frame - early.seen.back().frame);
    const double speed = cv::norm(early.velocity());
    const double off = cv::norm(early.predict(late.seen.front().frame) - late.seen.front().fit.centre);
    const double size = late.radius_px / early.radius_px;
    const double brightness = late.amplitude / early.amplitude;
    // It may have bounced while it was hidden.
    return off < 3.0 * early.radius_px + 2.2 * speed * std::min(gap, kLongestBounce) && size > 0.7 && size < 1.4 &&
           brightness > 0.5 && brightness < 2.0;
  };
  for (bool joined = true; joined;) {
    joined = false;
    std::size_t best_early = 0, best_late = 0, best_gap = frames_ + 1;
    for (std::size_t a = 0; a < paths_.size(); ++a) {
      for (std::size_t b = 0; b < paths_.size(); ++b) {
        if (a == b || !fits_on(paths_[a], paths_[b])) continue;
        const std::size_t gap = paths_[b].seen.front().frame - paths_[a].seen.back().frame;
        if (gap >= best_gap) continue;
        best_early = a;
        best_late = b;
        best_gap = gap;
      }
    }
    if (best_gap > frames_) break;
    for (const Seen& sighting : paths_[best_late].seen) paths_[best_early].push(sighting);
    paths_.erase(paths_.begin() + static_cast<std::ptrdiff_t>(best_late));
    joined = true;
  }
}

double MarkerTracker::size_ratio(const Path& path) const {
  std::vector<double> ratios;
  const std::size_t step = std::max<std::size_t>(1, path.seen.size() / 50);
  for (std::size_t i = 0; i < path.seen.size(); i += step) {
    ratios.push_back(path.seen[i].size());
  }
  return median_of(ratios);
}

/// The path that is nearest to start_px in the first frames.
std::size_t MarkerTracker::path_at_start() const {
  std::size_t best = paths_.size();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (paths_[i].seen.front().frame >= kStartFrames || paths_[i].seen.size() < kFewestMoving) continue;
    const double distance = cv::norm(paths_[i].seen.front().fit.centre - *marker_.start_px);
    if (distance >= nearest) continue;
    nearest = distance;
    best = i;
  }
  const double allowed = 3.0 * radius_px_ + 10.0;
  if (best == paths_.size() || nearest > allowed) {
    throw NoMarker(
        issue(fmt::format("no marker near start_px = [{:.1f}, {:.1f}] in the first frames{}", marker_.start_px->x,
                          marker_.start_px->y,
                          best == paths_.size() ? "" : fmt::format(" (the nearest is {:.0f} px off)", nearest)),
              fmt::format("one of about {:.1f} px radius within {:.0f} px", radius_px_, allowed)));
  }
  return best;
}

/// Where nothing moves: the one thing of the right size that is there all the time.
std::size_t MarkerTracker::resting_path(std::vector<std::string>& notes) const {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const double ratio = size_ratio(paths_[i]);
    if (2 * paths_[i].seen.size() >= frames_ && ratio > 0.75 && ratio < 1.33) candidates.push_back(i);
  }
  if (candidates.size() != 1) {
    throw NoMarker(
        issue(fmt::format("no marker: nothing of about {:.1f} px radius moves{}", radius_px_,
                          candidates.empty() ? "" : fmt::format(", and {} such things rest", candidates.size())),
              "a marker of the diameter stated, brighter or darker than what is around it (or of the colour stated), "
              "or start_px"));
  }
  notes.emplace_back("the marker does not move in this clip");
  return candidates.front();
}

std::size_t MarkerTracker::choose_path(std::vector<std::string>& notes) const {
  if (marker_.start_px) return path_at_start();
  const std::size_t fewest = std::min(kFewestMoving, std::max<std::size_t>(frames_ / 2, 2));
  std::vector<std::size_t> movers;
  double farthest = 0.0, brightest = 0.0, longest = 0.0;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const Path& path = paths_[i];
    if (path.seen.size() < fewest || path.travel_px < std::max(1.5 * path.radius_px, 5.0)) continue;
    movers.push_back(i);
    farthest = std::max(farthest, path.travel_px);
    brightest = std::max(brightest, path.amplitude);
    longest = std::max(longest, static_cast<double>(path.seen.size()));
  }
  if (movers.empty()) return resting_path(notes);
  // Squared deviations from what a marker is like, each over how much it may vary.
  const auto cost = [&](std::size_t i) {
    const Path& path = paths_[i];
    const double size = std::log(size_ratio(path)) / 0.2;
    const double travel = std::log(path.travel_px / farthest) / 0.5;
    const double bright = std::log(path.amplitude / brightest) / 0.7;
    const double length = std::log(static_cast<double>(path.seen.size()) / longest) / 0.7;
    return size * size + travel * travel + bright * bright + length * length;
  };
  const std::size_t best =
      *std::min_element(movers.begin(), movers.end(), [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  const Path& marker = paths_[best];
  for (const std::size_t i : movers) {
    if (i == best) continue;
    const Path& other = paths_[i];
    std::size_t common = 0;
    for (auto a = marker.seen.begin(), b = other.seen.begin(); a != marker.seen.end() && b != other.seen.end();) {
      if (a->frame == b->frame) ++common;
      if (a->frame <= b->frame) {
        ++a;
      } else {
        ++b;
      }
    }
    const auto alike = [](double x, double y, double factor) { return x < factor * y && y < factor * x; };
    if (overlaps(common, marker.seen.size(), other.seen.size()) && alike(marker.radius_px, other.radius_px, 1.2) &&
        alike(marker.amplitude, other.amplitude, 1.4) && alike(marker.travel_px, other.travel_px, 1.6)) {
      const cv::Point2d a = marker.seen.front().fit.centre, b = other.seen.front().fit.centre;
      throw base::InputError(
          issue(fmt::format(
                    "two markers that look and move alike, at ({:.0f}, {:.0f}) px in frame {} and ({:.0f}, {:.0f}) px "
                    "in frame {}",
                    a.x, a.y, marker.seen.front().frame, b.x, b.y, other.seen.front().frame),
                "one marker, or start_px in [marker] to say which"));
    }
  }
  return best;
}

/// The place of something that rested there long before the path came by.
bool MarkerTracker::is_place_of_another(const Path& path, const Seen& sighting) const {
  return std::any_of(paths_.begin(), paths_.end(), [&](const Path& other) {
    if (&other == &path || other.seen.size() < kFewestResting || other.travel_px > 0.75 * path.radius_px) return false;
    return other.seen[kFewestResting - 1].frame < sighting.frame &&
           cv::norm(other.seen.back().fit.centre - sighting.fit.centre) < 0.5 * path.radius_px;
  });
}

TrackedMarker MarkerTracker::finish() {
  search_rest();
  for (Path& path : paths_) {
    if (path.method == Method::undecided) choose_method(path);
  }
  join_pieces();
  std::erase_if(paths_, [&](const Path& path) { return path.seen.size() < 2; });
  TrackedMarker tracked;
  const Path& path = paths_[choose_path(tracked.notes)];

  // A marker that is half hidden is measured wrong: smaller, or with larger residuals, than in the frames around.
  std::vector<double> sizes, residuals;
  for (const Seen& sighting : path.seen) {
    sizes.push_back(sighting.size());
    residuals.push_back(sighting.fit.rms / sighting.fit.amplitude);
  }
  const double usual_size = median_of(sizes);
  std::vector<double> deviations;
  for (const double size : sizes) deviations.push_back(std::abs(size / usual_size - 1.0));
  const double size_limit = 0.1 + 6.0 * median_of(deviations);
  const double residual_limit = 0.03 + 4.0 * median_of(residuals);
  std::size_t dropped = 0;
  std::size_t hidden = 0;
  Places places;
  for (std::size_t i = 0; i < path.seen.size(); ++i) {
    const MarkerFit& fit = path.seen[i].fit;
    if (is_place_of_another(path, path.seen[i])) {
      ++hidden;
      continue;
    }
    if (std::abs(sizes[i] / usual_size - 1.0) > size_limit || residuals[i] > residual_limit) {
      ++dropped;
      continue;
    }
    tracked.sightings.push_back({path.seen[i].frame, fit.centre.x, fit.centre.y, fit.sd_px, fit.radius_px});
    tracked.fits.push_back(fit);
    places[path.seen[i].frame] = fit.centre;
  }
  if (hidden > 0) {
    tracked.notes.push_back(fmt::format(
        "in {} frames the marker cannot be told from something like it that rests there, and counts as not seen",
        hidden));
  }
  if (dropped > 0) {
    tracked.notes.push_back(
        fmt::format("in {} frames the marker is partly hidden or disturbed (its size or the residuals differ) and "
                    "counts as not seen",
                    dropped));
  }
  if (path.method == Method::centroid) {
    // A centroid has no covariance: its noise from the second differences (variance 1 + 4 + 1).
    const double sd = jitter_of(places).value_or(0.0) / std::sqrt(6.0);
    for (MarkerSighting& sighting : tracked.sightings) sighting.sd_px = sd;
    tracked.notes.emplace_back("the marker is no disc; its centroid by colour was used");
  }
  if (path.method == Method::shaded)
    tracked.notes.emplace_back("the marker is lit from one side; its shading is fitted");
  const double ratio = size_ratio(path);
  if (std::abs(std::log(ratio)) > 0.2) {
    tracked.notes.push_back(fmt::format("the marker looks {:.0f} % {} than its diameter says",
                                        100.0 * std::abs(ratio - 1.0), ratio > 1.0 ? "larger" : "smaller"));
  }
  return tracked;
}

}  // namespace glidelab::core
