#include "core/pictures/marker/marker_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>
#include <vector>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kBoxRadii = 2.2, kBoxMargin_px = 2.0;  // of the radius, with a margin: half the side of the box
constexpr double kMostRadiiOfMarker = 1.6;              // of the radius: pixels farther out are background
constexpr double kSmallest_px = 1.5;                    // the marker's pixels are sought at least as far out
constexpr std::size_t kFewestOfRim = 8;                 // pixels
constexpr double kFloorOfPeak = 0.2;                    // of the peak

/// The background by the median of the rim of the box, the peak by the brightest tenth near the guess.
struct Peak {
  double level;
  double amplitude;  ///< above the level, > 0
  double floor() const { return level + kFloorOfPeak * amplitude; }
};

cv::Rect box_around(const Signal& signal, const MarkerGuess& guess) {
  const double reach = kBoxRadii * guess.radius_px + kBoxMargin_px;
  const cv::Point corner(static_cast<int>(std::floor(guess.centre.x - reach)),
                         static_cast<int>(std::floor(guess.centre.y - reach)));
  const int side = 2 * static_cast<int>(std::ceil(reach)) + 1;
  return cv::Rect(corner.x, corner.y, side, side) & cv::Rect(0, 0, signal.values.cols, signal.values.rows);
}

/// Squared: a box around a large marker has a hundred thousand pixels.
double distance2_of(int u, int v, const MarkerGuess& guess) {
  const double du = u - guess.centre.x, dv = v - guess.centre.y;
  return du * du + dv * dv;
}

double near2_of(const MarkerGuess& guess) {
  const double near = std::max(guess.radius_px, kSmallest_px);
  return near * near;
}

std::optional<Peak> peak_in(const Signal& signal, const cv::Rect& box, const MarkerGuess& guess) {
  std::vector<double> rim, near;
  const double near2 = near2_of(guess), rim2 = std::pow(kMostRadiiOfMarker * guess.radius_px, 2.0);
  for (int v = box.y; v < box.br().y; ++v) {
    for (int u = box.x; u < box.br().x; ++u) {
      const double distance2 = distance2_of(u, v, guess);
      if (distance2 > rim2) rim.push_back(signal.at(u, v));
      if (distance2 < near2) near.push_back(signal.at(u, v));
    }
  }
  if (rim.size() < kFewestOfRim || near.empty()) return std::nullopt;
  const double level = median_of(std::move(rim));
  const auto high = near.begin() + static_cast<std::ptrdiff_t>(9 * near.size() / 10);
  std::nth_element(near.begin(), high, near.end());
  const double amplitude = *high - level;
  if (!(amplitude > 0.0)) return std::nullopt;
  return Peak{level, amplitude};
}

/// The brightest pixel near the guess that stands above the floor.
std::optional<cv::Point> brightest(const Signal& signal, const cv::Rect& box, const MarkerGuess& guess, double floor) {
  std::optional<cv::Point> found;
  double best = floor;
  const double near2 = near2_of(guess);
  for (int v = box.y; v < box.br().y; ++v) {
    for (int u = box.x; u < box.br().x; ++u) {
      if (distance2_of(u, v, guess) > near2) continue;
      if (signal.at(u, v) <= best) continue;
      best = signal.at(u, v);
      found = cv::Point(u, v);
    }
  }
  return found;
}

/// Pixels of the box above the floor that are connected with the seed side by side, the nearest first.
std::vector<cv::Point> connected(const Signal& signal, const cv::Rect& box, cv::Point seed, double floor) {
  cv::Mat taken = cv::Mat::zeros(box.size(), CV_8U);
  std::vector<cv::Point> found;
  std::queue<cv::Point> open;
  const auto take = [&](cv::Point at) {
    unsigned char& mark = taken.at<unsigned char>(at.y - box.y, at.x - box.x);
    if (mark == 0) open.push(at);
    mark = 1;
  };
  take(seed);
  while (!open.empty()) {
    const cv::Point here = open.front();
    open.pop();
    found.push_back(here);
    for (const cv::Point off : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
      const cv::Point next = here + off;
      if (box.contains(next) && signal.at(next.x, next.y) > floor) take(next);
    }
  }
  return found;
}

}  // namespace

std::optional<MarkerFit> centroid_of_marker(const Signal& signal, const MarkerGuess& guess) {
  const cv::Rect box = box_around(signal, guess);
  if (box.width < 3 || box.height < 3) return std::nullopt;
  signal.see(box);
  const std::optional<Peak> peak = peak_in(signal, box, guess);
  if (!peak) return std::nullopt;
  const double floor = peak->floor();
  const std::optional<cv::Point> seed = brightest(signal, box, guess, floor);
  if (!seed) return std::nullopt;

  double sum = 0.0, sum_u = 0.0, sum_v = 0.0, area = 0.0;
  for (const cv::Point& here : connected(signal, box, *seed, floor)) {
    // The weight rises linearly from 0 at the floor, so that a pixel that comes or goes there does not matter.
    const double weight = std::min((signal.at(here.x, here.y) - floor) / ((1.0 - kFloorOfPeak) * peak->amplitude), 1.0);
    sum += weight;
    sum_u += weight * here.x;
    sum_v += weight * here.y;
    area += std::min(weight * 2.0, 1.0);
  }
  if (!(sum > 0.0)) return std::nullopt;
  MarkerFit marker;
  marker.centre = {sum_u / sum, sum_v / sum};
  marker.radius_px = std::sqrt(area / std::numbers::pi);
  marker.amplitude = peak->amplitude;
  marker.background = peak->level;
  if (!has_expected_size(marker, guess)) return std::nullopt;
  return marker;
}

namespace {

constexpr double kLeastBicGainPerFrame = 10.0;  // average per frame: "very strong" on the usual scale
constexpr double kSmallestShadedPx = 3.0;       // below, shading cannot be told from a shift
constexpr double kMostDiscResidual = 0.1;       // relative to the amplitude; an object that is no disc leaves more
constexpr double kLeastJitterRatio = 1.2;       // a centroid must be steadier by this factor to be preferred to a disc

/// Starts each fit from what all windows share: the sharpness of the image and the size of the marker.
void share_guesses(std::vector<MarkerSample>& samples, SignalKind kind) {
  std::vector<double> blurs, sizes;
  for (const MarkerSample& sample : samples) {
    const auto fit = measure_marker(sample.window, sample.guess, MarkerMethod::uniform, kind);
    if (!fit) continue;
    blurs.push_back(fit->blur_px);
    sizes.push_back(fit->radius_px / sample.guess.radius_px);
  }
  for (MarkerSample& sample : samples) {
    if (blurs.empty()) break;
    sample.guess.blur_px = median_of(blurs);
    sample.guess.radius_px *= median_of(sizes);
    sample.guess.shape.reset();
  }
}

/// The samples, measured by every method that may be chosen.
struct Remeasured {
  std::map<MarkerMethod, std::map<std::size_t, MarkerFit>> fits = {
      {MarkerMethod::uniform, {}}, {MarkerMethod::shaded, {}}, {MarkerMethod::centroid, {}}};  ///< by frame
  double bic_gain = 0.0;  ///< gain of a shaded over a uniform surface, summed over frames
  std::size_t both = 0;   ///< frames with both fits
};

Remeasured remeasure(const std::vector<MarkerSample>& samples, SignalKind kind) {
  Remeasured again;
  for (const MarkerSample& sample : samples) {
    std::vector<MarkerMethod> methods{MarkerMethod::uniform};
    if (sample.guess.radius_px >= kSmallestShadedPx) methods.push_back(MarkerMethod::shaded);
    if (may_have_any_shape(kind)) methods.push_back(MarkerMethod::centroid);
    for (const MarkerMethod method : methods) {
      auto fit = measure_marker(sample.window, sample.guess, method, kind);
      if (!fit) continue;
      fit->centre += cv::Point2d(sample.corner);
      again.fits[method][sample.frame] = *fit;
    }
    const auto uniform = again.fits[MarkerMethod::uniform].find(sample.frame);
    const auto shaded = again.fits[MarkerMethod::shaded].find(sample.frame);
    if (uniform == again.fits[MarkerMethod::uniform].end() || shaded == again.fits[MarkerMethod::shaded].end())
      continue;
    again.bic_gain += uniform->second.bic - shaded->second.bic;
    ++again.both;
  }
  return again;
}

MarkerMethod best_of(const Remeasured& again, std::size_t samples, SignalKind kind) {
  const auto most = [&](MarkerMethod method) { return 10 * again.fits.at(method).size() >= 9 * samples; };
  const auto jitter = [&](MarkerMethod method) {
    Places places;
    for (const auto& [frame, fit] : again.fits.at(method)) places[frame] = fit.centre;
    return jitter_of(places);
  };
  MarkerMethod chosen = MarkerMethod::uniform;
  if (most(MarkerMethod::shaded) && again.both > 0 &&
      again.bic_gain > kLeastBicGainPerFrame * static_cast<double>(again.both))
    chosen = MarkerMethod::shaded;
  if (may_have_any_shape(kind) && most(MarkerMethod::centroid)) {
    std::vector<double> residuals{0.0};
    for (const auto& [frame, fit] : again.fits.at(chosen)) residuals.push_back(fit.rms / fit.amplitude);
    const auto of_fit = jitter(chosen);
    const auto of_centroid = jitter(MarkerMethod::centroid);
    const bool is_disc = most(chosen) && median_of(residuals) < kMostDiscResidual;
    if (!is_disc || (of_fit && of_centroid && *of_fit > kLeastJitterRatio * *of_centroid))
      chosen = MarkerMethod::centroid;
  }
  return chosen;
}

}  // namespace

std::optional<MarkerFit> measure_marker(const Signal& signal, const MarkerGuess& guess, MarkerMethod method,
                                        SignalKind kind) {
  std::optional<MarkerFit> fit;
  if (method == MarkerMethod::uniform || method == MarkerMethod::undecided)
    fit = fit_marker(signal, guess, Surface::uniform);
  if (method == MarkerMethod::shaded) fit = fit_marker(signal, guess, Surface::shaded);
  // An object that is told by its hue or its light may have any shape.
  if (method == MarkerMethod::centroid || (!fit && method == MarkerMethod::undecided && may_have_any_shape(kind))) {
    fit = centroid_of_marker(signal, guess);
  }
  if (fit && fit->amplitude < least_contrast(kind)) return std::nullopt;
  return fit;
}

void choose_method(MarkerPath& path, SignalKind kind, const RadiusAt& radius_at) {
  share_guesses(path.samples, kind);
  const Remeasured measured = remeasure(path.samples, kind);
  path.method = best_of(measured, path.samples.size(), kind);
  const std::map<std::size_t, MarkerFit>& fits = measured.fits.at(path.method);
  std::vector<MarkerSeen> kept;
  for (const MarkerSeen& sighting : path.seen) {
    const bool sampled = std::any_of(path.samples.begin(), path.samples.end(),
                                     [&](const MarkerSample& sample) { return sample.frame == sighting.frame; });
    const auto again = fits.find(sighting.frame);
    if (again != fits.end()) {
      kept.push_back({sighting.frame, again->second, radius_at(again->second.centre)});
    } else if (!sampled) {
      kept.push_back(sighting);  // found while following back, or at rest
    }
  }
  path.samples.clear();
  if (kept.size() < 2) return;
  path.seen.clear();
  path.travel_px = 0.0;
  for (const MarkerSeen& sighting : kept) path.push(sighting);
}

}  // namespace glidelab::core
