#include "core/plumb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "base/errors.h"
#include "core/estimate.h"
#include "core/picture.h"
#include "core/thread_fit.h"

namespace glidelab::core {
namespace {

constexpr int kWidest = 9;            // pixels; a thread is thinner
constexpr double kNear = 1.5;         // pixels from a straight line, for a row's place to lie on it
constexpr double kShareOfRows = 0.3;  // in which a thread must be seen
constexpr int kPlacesARow = 4;

struct Place {
  double along;   // row
  double at;      // column
  double excess;  // how far it stands out, signed: bright above zero
  cv::Point2d straight;
};

/// One row of the region (or column, where turned), as numbers.
std::vector<double> profile_of(const cv::Mat& grey, cv::Rect region, int row, bool turned) {
  std::vector<double> values;
  const int count = turned ? region.height : region.width;
  for (int i = 0; i < count; ++i) {
    const int u = turned ? region.x + row : region.x + i;
    const int v = turned ? region.y + i : region.y + row;
    values.push_back(grey.depth() == CV_8U ? static_cast<double>(grey.at<unsigned char>(v, u))
                                           : static_cast<double>(grey.at<unsigned short>(v, u)));
  }
  return values;
}

/// How far a value stands out from both sides: the smaller of the two differences to the means beside it, of one sign.
double excess_at(const std::vector<double>& values, int i, int width) {
  const auto mean = [&](int from, int to) {
    double sum = 0.0;
    for (int k = from; k < to; ++k) sum += values[static_cast<std::size_t>(k)];
    return sum / (to - from);
  };
  const int half = width / 2;
  const int side = width + 2;
  const int left = i - half - 2, right = i + half + 2;
  if (left - side < 0 || right + side >= static_cast<int>(values.size())) return 0.0;
  const double here = mean(i - half, i + half + 1);
  const double a = here - mean(left - side, left);
  const double b = here - mean(right + 1, right + side + 1);
  if (a > 0.0 && b > 0.0) return std::min(a, b);
  if (a < 0.0 && b < 0.0) return std::max(a, b);
  return 0.0;
}

/// The rows' places that lie on one straight line.
struct Thread {
  std::vector<Place> places;
  double strength = 0.0;
  int width = 1;
};

/// Directed from the place of the upper pixel to that of the lower one.
PlaneLine thread_line(const std::vector<cv::Point2d>& places, std::size_t upper, std::size_t lower) {
  PlaneLine line = fit_plane_line(places, 1e-7);
  if (line.direction.dot(places[lower] - places[upper]) < 0.0) line.direction = -line.direction;
  return line;
}

double inclination(const MotionAxis& axis, const PlaneLine& down) {
  return std::asin(std::clamp(axis.line().direction.dot(down.direction), -1.0, 1.0));
}

ThreadInPicture find_along(const cv::Mat& grey, cv::Rect region, bool turned,
                           const std::function<std::optional<cv::Point2d>(cv::Point2d)>& straight) {
  const int rows = turned ? region.width : region.height;
  const int columns = turned ? region.height : region.width;
  const auto pixel = [&](double row, double column) {
    return turned ? cv::Point2d(region.x + row, region.y + column) : cv::Point2d(region.x + column, region.y + row);
  };
  Thread best;
  for (const int width : {1, 3, 5, 9}) {
    // The places of each row that stand out most, of either sign.
    std::vector<Place> places;
    for (int row = 0; row < rows; ++row) {
      const std::vector<double> values = profile_of(grey, region, row, turned);
      std::vector<double> excess(values.size(), 0.0);
      for (int i = 0; i < columns; ++i) excess[static_cast<std::size_t>(i)] = excess_at(values, i, width);
      std::vector<Place> found;
      for (int i = 1; i + 1 < columns; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double here = std::abs(excess[k]);
        if (here == 0.0 || here < std::abs(excess[k - 1]) || here <= std::abs(excess[k + 1])) continue;
        found.push_back({static_cast<double>(row), static_cast<double>(i), excess[k], {}});
      }
      std::stable_sort(found.begin(), found.end(),
                       [](const Place& a, const Place& b) { return std::abs(a.excess) > std::abs(b.excess); });
      if (found.size() > kPlacesARow) found.resize(kPlacesARow);
      for (Place& place : found) {
        const auto undone = straight(pixel(place.along, place.at));
        if (!undone) continue;
        place.straight = *undone;
        places.push_back(place);
      }
    }
    if (places.size() < 6) continue;
    // Every pair of far rows proposes a line; the one on which most stands out wins. All pairs of a coarse grid of
    // rows.
    const double least_gap = 0.25 * rows;
    const std::size_t stride = std::max<std::size_t>(1, places.size() / 160);
    for (std::size_t a = 0; a < places.size(); a += stride) {
      for (std::size_t b = a + 1; b < places.size(); b += stride) {
        if (places[b].along - places[a].along < least_gap || places[a].excess * places[b].excess < 0.0) continue;
        const cv::Point2d direction = places[b].straight - places[a].straight;
        const double length = cv::norm(direction);
        double strength = 0.0;
        double last_row = -1.0;
        std::size_t seen = 0;
        for (const Place& place : places) {
          if (place.excess * places[a].excess < 0.0 || place.along == last_row) continue;
          if (std::abs(direction.cross(place.straight - places[a].straight)) > kNear * length) continue;
          strength += std::sqrt(std::abs(place.excess));  // a few strong places do not outweigh many
          last_row = place.along;
          ++seen;
        }
        if (static_cast<double>(seen) < std::max(6.0, kShareOfRows * rows) || strength <= 1.05 * best.strength)
          continue;
        best.strength = strength;
        best.width = width;
        best.places.clear();
        last_row = -1.0;
        for (const Place& place : places) {
          if (place.excess * places[a].excess < 0.0 || place.along == last_row) continue;
          if (std::abs(direction.cross(place.straight - places[a].straight)) > kNear * length) continue;
          last_row = place.along;
          best.places.push_back(place);
        }
      }
    }
  }
  ThreadInPicture thread;
  if (best.places.empty()) return thread;
  // Its course: straight where the lens's distortion is undone, brought back to the picture row by row.
  std::vector<cv::Point2d> straights;
  for (const Place& place : best.places) straights.push_back(place.straight);
  const PlaneLine line = fit_plane_line(straights, kNear / 3.0);
  std::vector<ThreadRow> seen;
  for (const Place& place : best.places) {
    double at = place.at;
    for (int iteration = 0; iteration < 5; ++iteration) {
      const auto here = straight(pixel(place.along, at)), beside = straight(pixel(place.along, at + 0.5));
      if (!here || !beside) break;
      const double slope = 2.0 * (line.across(*beside) - line.across(*here));
      if (slope == 0.0) break;
      at -= std::clamp(line.across(*here) / slope, -2.0, 2.0);
    }
    seen.push_back({place.along, profile_of(grey, region, static_cast<int>(place.along), turned), at});
  }
  const double slant = (seen.back().middle - seen.front().middle) / (seen.back().row - seen.front().row);
  const auto fit = fit_thread(seen, slant, best.width);
  if (!fit) return thread;
  for (const ThreadRow& row : seen) {
    const double arm = row.row - fit->mean_row;
    const double middle = row.middle + fit->shift + fit->turn * arm;
    thread.points.push_back(pixel(row.row, middle));
    thread.turned.push_back(pixel(row.row, middle + fit->sd_turn * arm));
  }
  thread.rows = fit->rows;
  return thread;
}

}  // namespace

ThreadInPicture find_thread(const cv::Mat& grey, cv::Rect region,
                            const std::function<std::optional<cv::Point2d>(cv::Point2d)>& straight) {
  const ThreadInPicture upright = find_along(grey, region, false, straight);
  const ThreadInPicture lying = find_along(grey, region, true, straight);
  // A line is followed best across: in as many rows (columns) as it spans.
  return lying.rows > upright.rows ? lying : upright;
}

Quantity plumb_angle(const PlumbSetup& setup, const Restitution& restitution, const MotionAxis& axis,
                     std::optional<cv::Size> picture_size, const std::vector<ModeAxis>& modes) {
  const cv::Mat grey = read_grey_picture(setup.view);
  const auto fail = [&](std::string found, std::string expected) {
    throw base::InputError(base::Issue{setup.view.string(), 0, "plumb", std::move(found), std::move(expected)});
  };
  if (picture_size && grey.size() != *picture_size) {
    fail(fmt::format("{} x {} pixels", grey.cols, grey.rows),
         fmt::format("{} x {} pixels, as the pattern's views", picture_size->width, picture_size->height));
  }
  if ((setup.region & cv::Rect(0, 0, grey.cols, grey.rows)) != setup.region) {
    fail(fmt::format("the region [{}, {}, {}, {}]", setup.region.x, setup.region.y, setup.region.width,
                     setup.region.height),
         fmt::format("a region inside the picture of {} x {} pixels", grey.cols, grey.rows));
  }
  const auto straight = [&](cv::Point2d pixel) { return restitution.undistorted(pixel); };
  const ThreadInPicture thread = find_thread(grey, setup.region, straight);
  std::vector<cv::Point2d> places, turned, centres;
  for (std::size_t i = 0; i < thread.points.size(); ++i) {
    const auto place = restitution.to_plane(thread.points[i]), other = restitution.to_plane(thread.turned[i]);
    if (!place || !other) continue;
    places.push_back(*place);
    turned.push_back(*other);
    centres.push_back(restitution.centre_pixel(*place));
  }
  if (places.size() < 6) fail("no thin straight line in the region", "a dark or bright thread");
  if (!std::isfinite(axis.line().sd_angle_rad)) return undetermined("the marker does not move, so its line is unknown");
  const auto [top, bottom] =
      std::minmax_element(centres.begin(), centres.end(), [](cv::Point2d a, cv::Point2d b) { return a.y < b.y; });
  const auto first = static_cast<std::size_t>(top - centres.begin());
  const auto last = static_cast<std::size_t>(bottom - centres.begin());
  const PlaneLine line = thread_line(places, first, last);
  const double alpha = inclination(axis, line);
  const double of_thread = inclination(axis, thread_line(turned, first, last)) - alpha;
  double variance = of_thread * of_thread + std::pow(axis.line().sd_angle_rad, 2);
  for (const ModeAxis& mode : modes) {
    std::vector<cv::Point2d> displaced;
    for (std::size_t i = 0; i < places.size(); ++i) {
      displaced.push_back(mode.mode.to_plane(centres[i]).value_or(places[i]));
    }
    const double moved = inclination(mode.axis, thread_line(displaced, first, last));
    variance += std::pow((moved - alpha) / mode.mode.sds, 2);
  }
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return determined(estimate(alpha * kDegrees, std::sqrt(variance) * kDegrees, static_cast<double>(thread.rows) - 2.0));
}

}  // namespace glidelab::core
