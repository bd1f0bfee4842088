#include "core/pictures/marker/marker_centroid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <vector>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kReach = 2.2, kReachMargin_px = 2.0;  // of the radius: half a side of the box that is looked at
constexpr double kRim = 1.6;                           // of the radius: what is farther out is background
constexpr double kSmallest_px = 1.5;                   // a marker's pixels are looked for so far at least
constexpr std::size_t kFewestOfRim = 8;                // pixels
constexpr double kFloor = 0.2;                         // of the peak

/// The background from the rim of the box, the peak from the brightest tenth near the guess.
struct Peak {
  double level;
  double amplitude;  ///< above the level, > 0
  double floor() const { return level + kFloor * amplitude; }
};

cv::Rect box_around(const Signal& signal, const MarkerGuess& guess) {
  const double reach = kReach * guess.radius_px + kReachMargin_px;
  const cv::Point corner(static_cast<int>(std::floor(guess.centre.x - reach)),
                         static_cast<int>(std::floor(guess.centre.y - reach)));
  const int side = 2 * static_cast<int>(std::ceil(reach)) + 1;
  return cv::Rect(corner.x, corner.y, side, side) & cv::Rect(0, 0, signal.values.cols, signal.values.rows);
}

double distance_of(int u, int v, const MarkerGuess& guess) {
  return std::hypot(u - guess.centre.x, v - guess.centre.y);
}

std::optional<Peak> peak_in(const Signal& signal, const cv::Rect& box, const MarkerGuess& guess) {
  std::vector<double> rim, near;
  for (int v = box.y; v < box.br().y; ++v) {
    for (int u = box.x; u < box.br().x; ++u) {
      const double distance = distance_of(u, v, guess);
      if (distance > kRim * guess.radius_px) rim.push_back(signal.at(u, v));
      if (distance < std::max(guess.radius_px, kSmallest_px)) near.push_back(signal.at(u, v));
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
  for (int v = box.y; v < box.br().y; ++v) {
    for (int u = box.x; u < box.br().x; ++u) {
      if (distance_of(u, v, guess) > std::max(guess.radius_px, kSmallest_px)) continue;
      if (signal.at(u, v) <= best) continue;
      best = signal.at(u, v);
      found = cv::Point(u, v);
    }
  }
  return found;
}

/// Pixels of the box that hang together with the seed, side by side, and stand above the floor; the nearest first.
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
    // Rises linearly from nothing at the floor, so that a pixel that comes or goes there does not matter.
    const double weight = std::min((signal.at(here.x, here.y) - floor) / ((1.0 - kFloor) * peak->amplitude), 1.0);
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

}  // namespace glidelab::core
