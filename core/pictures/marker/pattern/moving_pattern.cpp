#include "core/pictures/marker/pattern/moving_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
namespace glidelab::core {
namespace {

constexpr std::size_t kSearches = 16;        // of a clip for new patterns,
constexpr std::size_t kLongestBetween = 24;  // at most so many frames apart
constexpr std::size_t kMostSpots = 200;      // in a search
constexpr double kPatternReach = 1.15;       // radii around the centre in which a pattern is compared with itself
constexpr double kFarthestFromSpot = 0.25;   // radii from where a pattern is found roughly to its centre
constexpr float kLeastTurnedRoughly = 0.4F;  // correlation of a pattern with itself after half a turn
constexpr float kLeastSd = 2.0F;             // codes of 8 bits: less is noise
constexpr double kLeastTurned = 0.8;         // correlation of a pattern with itself after half a turn, about its centre
constexpr double kMostShifted = 0.8;         // and after a shift by half a radius or more
constexpr double kLeastAlike = 0.75;         // correlation of a pattern with itself in another frame
constexpr double kLookReach = 1.3;           // radii: half the side of what is matched
constexpr double kFirstGateRadii = 2.5;      // around a pattern whose speed is not known yet;
constexpr double kGateRadii = 0.75;      // later around the expected place: a jump from stripe to stripe is no motion,
constexpr double kGateSteps = 2.2;       // and times its step, for it may bounce
constexpr std::size_t kMostMissed = 6;   // frames in a row
constexpr std::size_t kRestFrames = 12;  // after which a pattern that has not moved is given up until it is new
constexpr std::size_t kFewestFrames = 8;
constexpr std::size_t kFewestForSpeed = 3;
constexpr double kAsLong = 0.9;           // of the frames of the longest: the most alike after half a turn comes first
constexpr double kNodesPerRadius = 12.0;  // of the comparison after half a turn

cv::Mat single_precision(const cv::Mat& grey, const cv::Rect& part) {
  cv::Mat codes;
  grey(part).convertTo(codes, CV_32F);
  return codes;
}

cv::Rect square_around(cv::Point2d centre, int half) {
  return {static_cast<int>(std::lround(centre.x)) - half, static_cast<int>(std::lround(centre.y)) - half, 2 * half + 1,
          2 * half + 1};
}

bool is_inside(const cv::Rect& part, const cv::Mat& grey) {
  return (part & cv::Rect({}, grey.size())) == part;
}

/// The correlation of the pixels around a centre with those after half a turn. The centre is a multiple of half a
/// pixel, given twice.
double turned_correlation(const cv::Mat& codes, cv::Point twice, double reach, int step) {
  double n = 0.0, sum = 0.0, squares = 0.0, products = 0.0;
  const int half = static_cast<int>(std::ceil(reach));
  for (int v = (twice.y - 2 * half) / 2; 2 * v <= twice.y; v += step) {
    for (int u = (twice.x - 2 * half) / 2; 2 * u <= twice.x + 2 * half; u += step) {
      const double du = u - 0.5 * twice.x, dv = v - 0.5 * twice.y;
      if (du * du + dv * dv > reach * reach) continue;
      const double here = codes.at<float>(v, u), turned = codes.at<float>(twice.y - v, twice.x - u);
      n += 2.0;
      sum += here + turned;
      squares += here * here + turned * turned;
      products += 2.0 * here * turned;
    }
  }
  const double variance = squares - sum * sum / n;
  return variance > 0.0 ? (products - sum * sum / n) / variance : 0.0;
}

/// Where the surroundings of a spot are most like themselves after half a turn. Empty if they are not.
std::optional<cv::Point2d> centre_near(const cv::Mat& grey, cv::Point2d spot, double radius_px) {
  const double reach = kPatternReach * radius_px, farthest = kFarthestFromSpot * radius_px;
  const int half = static_cast<int>(std::ceil(reach + farthest)) + 2;
  const cv::Rect part = square_around(spot, half);
  if (!is_inside(part, grey)) return std::nullopt;
  const cv::Mat codes = single_precision(grey, part);
  const int step = std::max(1, static_cast<int>(std::lround(radius_px / kNodesPerRadius)));
  const int most = static_cast<int>(std::floor(2.0 * farthest));
  double best = kLeastTurned;
  std::optional<cv::Point2d> centre;
  for (int dv = -most; dv <= most; dv += step) {
    for (int du = -most; du <= most; du += step) {
      if (du * du + dv * dv > most * most) continue;
      const double alike = turned_correlation(codes, {2 * half + du, 2 * half + dv}, reach, step);
      if (alike <= best) continue;
      best = alike;
      centre = cv::Point2d(part.tl()) + cv::Point2d(half + 0.5 * du, half + 0.5 * dv);
    }
  }
  return centre;
}

struct Centre {
  cv::Point2d at;
  double turned = 0.0;  ///< correlation with itself after half a turn; 0: not known
};

/// The centre about which the pixels are most alike after half a turn, from one that is nearly it, to a small part of a
/// pixel: places to whole pixels err alike wherever the pattern lies alike in its pixels, and a look that is the mean
/// of such places hardly loses that. The correlations about the points of a grid of half pixels, less their mean, are
/// those of a smooth function, whose maximum is that of a parabola through three of them.
Centre refined_centre(const cv::Mat& grey, cv::Point2d centre, double radius_px) {
  constexpr int kMostHalves = 4;  // of half a pixel
  const double reach = kPatternReach * radius_px;
  const cv::Rect part = square_around(centre, static_cast<int>(std::ceil(reach)) + kMostHalves + 1);
  if (!is_inside(part, grey)) return {centre};
  const cv::Mat codes = single_precision(grey, part);
  const cv::Point2d within = centre - cv::Point2d(part.tl());
  cv::Point twice(static_cast<int>(std::lround(2.0 * within.x)), static_cast<int>(std::lround(2.0 * within.y)));
  const auto alike = [&](int du, int dv) { return turned_correlation(codes, twice + cv::Point(du, dv), reach, 1); };
  for (int step = 0; step <= kMostHalves; ++step) {
    const double here = alike(0, 0), left = alike(-1, 0), right = alike(1, 0), up = alike(0, -1), down = alike(0, 1);
    const auto towards = [&](double before, double after) {
      return std::max(before, after) <= here ? 0 : before > after ? -1 : 1;
    };
    const cv::Point next(towards(left, right), towards(up, down));
    if (next != cv::Point()) {
      twice += next;
      continue;
    }
    const auto off = [&](double before, double after) {
      const double bend = 2.0 * here - before - after;
      return bend > 0.0 ? 0.5 * (after - before) / bend : 0.0;
    };
    const cv::Point2d beyond(off(left, right), off(up, down));
    return {cv::Point2d(part.tl()) + 0.5 * (cv::Point2d(twice) + beyond),
            here + 0.25 * ((right - left) * beyond.x + (down - up) * beyond.y)};
  }
  return {centre};
}

class Followed {
 public:
  /// Empty if it cannot be told from what it is after a shift.
  static std::optional<Followed> at(const cv::Mat& grey, std::size_t frame, cv::Point2d centre, double radius_px) {
    Followed made;
    made.radius_px_ = radius_px;
    const int half = static_cast<int>(std::ceil(kLookReach * radius_px)),
              around = half + static_cast<int>(std::ceil(radius_px));
    const cv::Rect part = square_around(centre, half), wide = square_around(centre, around);
    if (!is_inside(wide, grey)) return std::nullopt;
    made.look_ = single_precision(grey, part);
    made.off_ = centre - 0.5 * (cv::Point2d(part.tl()) + cv::Point2d(part.br() - cv::Point(1, 1)));
    cv::Mat alike;
    cv::matchTemplate(single_precision(grey, wide), made.look_, alike, cv::TM_CCOEFF_NORMED);
    const int middle = around - half;
    for (int v = 0; v < alike.rows; ++v) {
      for (int u = 0; u < alike.cols; ++u) {
        if (std::hypot(u - middle, v - middle) >= 0.5 * radius_px && alike.at<float>(v, u) > kMostShifted)
          return std::nullopt;
      }
    }
    const Centre refined = refined_centre(grey, centre, radius_px);
    made.turned_ = refined.turned;
    made.push(frame, refined.at);
    return made;
  }

  void follow(const cv::Mat& grey, std::size_t frame) {
    const cv::Point2d expected = path_.predict(frame);
    const double gate = path_.seen.size() < kFewestForSpeed
                            ? kFirstGateRadii * radius_px_
                            : kGateRadii * radius_px_ + kGateSteps * cv::norm(path_.velocity());
    const int half = look_.rows / 2 + static_cast<int>(std::ceil(gate));
    const cv::Rect part = square_around(expected - off_, half) & cv::Rect({}, grey.size());
    ++missed_;
    if (part.width < look_.cols || part.height < look_.rows) return;
    cv::Mat alike;
    cv::matchTemplate(single_precision(grey, part), look_, alike, cv::TM_CCOEFF_NORMED);
    double best = 0.0;
    cv::Point where;
    cv::minMaxLoc(alike, nullptr, &best, nullptr, &where);
    if (best < kLeastAlike) return;
    missed_ = 0;
    const cv::Point2d middle = 0.5 * cv::Point2d(look_.cols - 1, look_.rows - 1);
    push(frame, refined_centre(grey, cv::Point2d(part.tl() + where) + middle + off_, radius_px_).at);
  }

  bool is_lost() const { return missed_ > kMostMissed; }
  bool rests() const { return path_.seen.size() >= kRestFrames && path_.travel_px < 0.5 * least_travel(radius_px_); }
  bool moved() const { return path_.seen.size() >= kFewestFrames && steady_travel(path_) >= least_travel(radius_px_); }
  bool is_near(cv::Point2d place) const { return cv::norm(path_.seen.back().fit.centre - place) < 0.5 * radius_px_; }
  std::size_t seen() const { return path_.seen.size(); }
  double turned() const { return turned_; }

  MovingPattern pattern() const {
    MovingPattern pattern;
    pattern.look = look_;
    for (const MarkerSeen& seen : path_.seen) {
      const cv::Point2d at = seen.fit.centre;
      pattern.rough.sightings.push_back({seen.frame, at.x, at.y, 0.5, radius_px_});
      pattern.rough.fits.push_back(seen.fit);
    }
    return pattern;
  }

 private:
  void push(std::size_t frame, cv::Point2d at) {
    MarkerSeen seen;
    seen.frame = frame;
    seen.fit.centre = at;
    seen.fit.radius_px = radius_px_;
    seen.expected_px = radius_px_;
    path_.push(seen);
  }

  cv::Mat look_;
  cv::Point2d off_;  ///< from the middle of the look to the centre
  MarkerPath path_;
  double turned_ = 0.0;  ///< correlation with itself after half a turn, in the first frame
  double radius_px_ = 0.0;
  std::size_t missed_ = 0;
};

/// The correlation of the surroundings of each pixel with themselves after half a turn, where they lie in the image.
cv::Mat turned_correlations(const cv::Mat& values, double reach) {
  const int half = static_cast<int>(std::floor(reach));
  cv::Mat found = cv::Mat::zeros(values.size(), CV_32F);
  const cv::Rect inner(half, half, values.cols - 2 * half, values.rows - 2 * half);
  if (inner.width <= 0 || inner.height <= 0) return found;
  const cv::Mat off = values - cv::mean(values)[0];  // sums of squares of small numbers, in single precision
  cv::Mat sums = off(inner).clone(), squares, products = off(inner).mul(off(inner));
  squares = products.clone();
  float n = 1.0F;
  for (int dv = 0; dv <= half; ++dv) {
    for (int du = dv == 0 ? 1 : -half; du <= half; ++du) {
      if (du * du + dv * dv > reach * reach) continue;
      const cv::Mat here = off(inner + cv::Point(du, dv)), turned = off(inner - cv::Point(du, dv));
      sums += here;
      sums += turned;
      cv::accumulateSquare(here, squares);
      cv::accumulateSquare(turned, squares);
      cv::accumulateProduct(here, turned, products);
      cv::accumulateProduct(here, turned, products);
      n += 2.0F;
    }
  }
  const cv::Mat of_mean = sums.mul(sums) / n;
  cv::Mat variances = squares - of_mean;
  cv::max(variances, n * kLeastSd * kLeastSd, variances);
  cv::divide(products - of_mean, variances, found(inner));
  return found;
}

/// Centres of patterns that are the same after half a turn, the most alike first.
std::vector<cv::Point2d> symmetric_spots(const cv::Mat& grey, double radius_px) {
  const double scale = std::min(1.0, kNodesPerRadius / radius_px);
  cv::Mat values;
  grey.convertTo(values, CV_32F, grey.depth() == CV_8U ? 1.0 : 1.0 / 257.0);
  if (scale < 1.0) cv::resize(values, values, {}, scale, scale, cv::INTER_AREA);
  const cv::Point2d to_image(static_cast<double>(grey.cols) / values.cols,
                             static_cast<double>(grey.rows) / values.rows);
  const cv::Mat alike = turned_correlations(values, kPatternReach * radius_px * scale);
  cv::Mat highest;
  const int beside = std::max(1, static_cast<int>(std::lround(0.5 * radius_px * scale)));
  cv::dilate(alike, highest, cv::Mat::ones(2 * beside + 1, 2 * beside + 1, CV_8U));
  std::vector<std::pair<float, cv::Point2d>> spots;
  for (int v = 0; v < alike.rows; ++v) {
    for (int u = 0; u < alike.cols; ++u) {
      const float here = alike.at<float>(v, u);
      if (here < kLeastTurnedRoughly || here < highest.at<float>(v, u)) continue;
      spots.emplace_back(here, cv::Point2d((u + 0.5) * to_image.x - 0.5, (v + 0.5) * to_image.y - 0.5));
    }
  }
  std::ranges::stable_sort(spots, std::ranges::greater{}, [](const auto& spot) { return spot.first; });
  if (spots.size() > kMostSpots) spots.resize(kMostSpots);
  std::vector<cv::Point2d> places;
  for (const auto& [value, place] : spots) places.push_back(place);
  return places;
}

}  // namespace

std::vector<MovingPattern> moving_patterns(const ClipAgain& clip, const RadiusAt& radius_at) {
  const std::size_t every = std::clamp<std::size_t>(clip.frames / kSearches, 1, kLongestBetween);
  std::vector<Followed> followed, ended;
  const auto source = clip.open();
  while (const auto frame = source->next()) {
    for (Followed& one : followed) one.follow(frame->grey, frame->index);
    if (frame->index % every == 0) {
      const cv::Point2d middle(0.5 * (frame->grey.cols - 1), 0.5 * (frame->grey.rows - 1));
      for (const cv::Point2d& spot : symmetric_spots(frame->grey, radius_at(middle))) {
        const double radius_px = radius_at(spot);
        const auto centre = centre_near(frame->grey, spot, radius_px);
        if (!centre) continue;
        const bool known = std::ranges::any_of(followed, [&](const Followed& one) { return one.is_near(*centre); });
        if (known) continue;
        if (auto found = Followed::at(frame->grey, frame->index, *centre, radius_px)) followed.push_back(*found);
      }
    }
    for (const Followed& one : followed) {
      if (one.is_lost() && one.moved()) ended.push_back(one);
    }
    std::erase_if(followed, [](const Followed& one) { return one.is_lost() || one.rests(); });
  }
  ended.insert(ended.end(), followed.begin(), followed.end());
  std::erase_if(ended, [](const Followed& one) { return !one.moved(); });
  // The end of a plate and the edge of the pattern on it are alike after half a turn too, but less so.
  std::ranges::stable_sort(ended, std::ranges::greater{}, &Followed::seen);
  const auto as_long = std::ranges::find_if(ended, [&](const Followed& one) {
    return static_cast<double>(one.seen()) < kAsLong * static_cast<double>(ended.front().seen());
  });
  std::stable_sort(ended.begin(), as_long,
                   [](const Followed& a, const Followed& b) { return a.turned() > b.turned(); });
  std::vector<MovingPattern> patterns;
  for (const Followed& one : ended) patterns.push_back(one.pattern());
  return patterns;
}

bool are_twins(const MovingPattern& one, const MovingPattern& other) {
  constexpr double kAsFar = 1.6;
  const Places places = places_of(one.rough);
  std::size_t common = 0;
  for (const MarkerSighting& sighting : other.rough.sightings) {
    const auto at = places.find(sighting.frame);
    if (at == places.end()) continue;
    if (cv::norm(at->second - cv::Point2d(sighting.u_px, sighting.v_px)) < sighting.radius_px) return false;  // itself
    ++common;
  }
  if (2 * common < std::min(one.rough.sightings.size(), other.rough.sightings.size())) return false;
  const auto travel = [](const MovingPattern& pattern) {
    MarkerPath path;
    for (std::size_t i = 0; i < pattern.rough.fits.size(); ++i)
      path.push({pattern.rough.sightings[i].frame, pattern.rough.fits[i], 0.0});
    return steady_travel(path);
  };
  const double far = travel(one), other_far = travel(other);
  if (far > kAsFar * other_far || other_far > kAsFar * far) return false;
  const cv::Mat &small = one.look.rows < other.look.rows ? one.look : other.look,
                &large = one.look.rows < other.look.rows ? other.look : one.look;
  cv::Mat alike;
  cv::matchTemplate(large, small, alike, cv::TM_CCOEFF_NORMED);
  double best = 0.0;
  cv::minMaxLoc(alike, nullptr, &best);
  return best > kLeastAlike;
}

}  // namespace glidelab::core
