#include "core/pictures/camera/plumb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/math/angles.h"
#include "core/pictures/camera/motion_axis.h"
#include "core/pictures/camera/thread_fit.h"
#include "core/pictures/frames/read_image.h"
#include "core/result/estimate.h"

namespace glidelab::core {
namespace {

constexpr double kMostOffLine = 1.5;         // pixels from a straight line within which a row's position lies on it
constexpr double kLeastShareOfRows = 0.3;    // in which a thread must be seen
constexpr double kFewestRowsSeen = 6.0;      // the same, as a number of rows
constexpr std::size_t kPlacesARow = 4;       // number of positions in a row that stand out most
constexpr std::size_t kPlacesPaired = 160;   // number of all positions, chosen evenly, of which every pair proposes a
                                             // line
constexpr double kLeastPairDistance = 0.25;  // fraction of the rows by which the two of a pair are apart at least
constexpr double kLeastGain = 1.05;          // times, that a line must be to stand before one found earlier
constexpr int kCourseRounds = 5;             // of Newton's method

using Straight = std::function<std::optional<cv::Point2d>(cv::Point2d)>;

struct Place {
  double along;   // row
  double at;      // column
  double excess;  // how far it stands out, signed: bright above zero
  cv::Point2d straight;
};

/// The rows' positions that lie on one straight line.
struct Thread {
  std::vector<Place> places;
  double strength = 0.0;
  int width = 1;
};

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

/// A line through two positions, on which positions of the same sign may lie, one a row.
class Proposal {
 public:
  Proposal(const Place& a, const Place& b)
      : from_(a), direction_(b.straight - a.straight), near_(kMostOffLine * cv::norm(direction_)) {}

  template <typename Visit>
  void for_each(const std::vector<Place>& places, Visit visit) const {
    double last_row = -1.0;
    for (const Place& place : places) {
      if (place.excess * from_.excess < 0.0 || place.along == last_row) continue;
      if (std::abs(direction_.cross(place.straight - from_.straight)) > near_) continue;
      last_row = place.along;
      visit(place);
    }
  }

 private:
  const Place& from_;
  cv::Point2d direction_;
  double near_;
};

/// The region row by row, or, turned, column by column.
class Search {
 public:
  Search(const cv::Mat& grey, cv::Rect region, bool turned, const Straight& straight)
      : grey_(grey), region_(region), turned_(turned), straight_(straight) {}

  ThreadInImage find() const {
    Thread best;
    for (const int width : {1, 3, 5, 9}) {
      const std::vector<Place> places = places_of(width);
      if (static_cast<double>(places.size()) >= kFewestRowsSeen) best = stronger(best, places, width);
    }
    return best.places.empty() ? ThreadInImage{} : fitted(best);
  }

 private:
  int rows() const { return turned_ ? region_.width : region_.height; }
  int columns() const { return turned_ ? region_.height : region_.width; }
  cv::Point2d pixel(double row, double column) const {
    return turned_ ? cv::Point2d(region_.x + row, region_.y + column)
                   : cv::Point2d(region_.x + column, region_.y + row);
  }

  std::vector<double> profile(int row) const {
    std::vector<double> values;
    for (int i = 0; i < columns(); ++i) {
      const int u = turned_ ? region_.x + row : region_.x + i;
      const int v = turned_ ? region_.y + i : region_.y + row;
      values.push_back(grey_.depth() == CV_8U ? static_cast<double>(grey_.at<unsigned char>(v, u))
                                              : static_cast<double>(grey_.at<unsigned short>(v, u)));
    }
    return values;
  }

  /// The positions in a row that stand out most, of either sign.
  std::vector<Place> places_in(int row, int width) const {
    const std::vector<double> values = profile(row);
    std::vector<double> excess(values.size(), 0.0);
    for (int i = 0; i < columns(); ++i) excess[static_cast<std::size_t>(i)] = excess_at(values, i, width);
    std::vector<Place> found;
    for (std::size_t k = 1; k + 1 < excess.size(); ++k) {
      const double here = std::abs(excess[k]);
      if (here == 0.0 || here < std::abs(excess[k - 1]) || here <= std::abs(excess[k + 1])) continue;
      found.push_back({static_cast<double>(row), static_cast<double>(k), excess[k], {}});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Place& a, const Place& b) { return std::abs(a.excess) > std::abs(b.excess); });
    if (found.size() > kPlacesARow) found.resize(kPlacesARow);
    return found;
  }

  /// For all rows in which the lens's distortion can be undone.
  std::vector<Place> places_of(int width) const {
    std::vector<Place> places;
    for (int row = 0; row < rows(); ++row) {
      for (Place& place : places_in(row, width)) {
        const auto undone = straight_(pixel(place.along, place.at));
        if (!undone) continue;
        place.straight = *undone;
        places.push_back(place);
      }
    }
    return places;
  }

  /// The line along which most stands out, or `best` if none is better.
  Thread stronger(Thread best, const std::vector<Place>& places, int width) const {
    const std::size_t stride = std::max<std::size_t>(1, places.size() / kPlacesPaired);
    for (std::size_t a = 0; a < places.size(); a += stride) {
      for (std::size_t b = a + 1; b < places.size(); b += stride) {
        if (places[b].along - places[a].along < kLeastPairDistance * rows()) continue;
        if (places[a].excess * places[b].excess < 0.0) continue;
        const Proposal line(places[a], places[b]);
        double strength = 0.0, seen = 0.0;
        line.for_each(places, [&](const Place& place) {
          strength += std::sqrt(std::abs(place.excess));  // a few strong places do not outweigh many
          seen += 1.0;
        });
        if (seen < std::max(kFewestRowsSeen, kLeastShareOfRows * rows()) || strength <= kLeastGain * best.strength)
          continue;
        best = {{}, strength, width};
        line.for_each(places, [&](const Place& place) { best.places.push_back(place); });
      }
    }
    return best;
  }

  /// Its course: straight where the lens's distortion is undone, brought back to the image row by row.
  std::vector<ThreadRow> course_of(const std::vector<Place>& places) const {
    std::vector<cv::Point2d> straights;
    for (const Place& place : places) straights.push_back(place.straight);
    const PlaneLine line = fit_plane_line(straights, kMostOffLine / 3.0);
    std::vector<ThreadRow> course;
    for (const Place& place : places) {
      double at = place.at;
      for (int round = 0; round < kCourseRounds; ++round) {
        const auto here = straight_(pixel(place.along, at)), beside = straight_(pixel(place.along, at + 0.5));
        if (!here || !beside) break;
        const double slope = 2.0 * (line.across(*beside) - line.across(*here));
        if (slope == 0.0) break;
        at -= std::clamp(line.across(*here) / slope, -2.0, 2.0);  // a step, not a value: rounds go on
      }
      course.push_back({place.along, profile(static_cast<int>(place.along)), at});
    }
    return course;
  }

  ThreadInImage fitted(const Thread& found) const {
    const std::vector<ThreadRow> course = course_of(found.places);
    const double slant = (course.back().middle - course.front().middle) / (course.back().row - course.front().row);
    ThreadInImage thread;
    const auto fit = fit_thread(course, slant, found.width);
    if (!fit) return thread;
    for (const ThreadRow& row : course) {
      const double arm = row.row - fit->mean_row;
      const double middle = row.middle + fit->shift + fit->turn * arm;
      thread.points.push_back(pixel(row.row, middle));
      thread.turned.push_back(pixel(row.row, middle + fit->sd_turn * arm));
    }
    thread.rows = fit->rows;
    return thread;
  }

  const cv::Mat& grey_;
  cv::Rect region_;
  bool turned_;
  const Straight& straight_;
};

}  // namespace

ThreadInImage find_thread(const cv::Mat& grey, cv::Rect region, const Straight& straight) {
  const ThreadInImage upright = Search(grey, region, false, straight).find();
  const ThreadInImage lying = Search(grey, region, true, straight).find();
  // A line is followed best across: in as many rows (columns) as it spans.
  return lying.rows > upright.rows ? lying : upright;
}

namespace {

constexpr std::size_t kFewestPlaces = 6;  // of a thread, on the plane of motion

/// Directed from the place of the upper pixel to that of the lower one.
PlaneLine thread_line(const std::vector<cv::Point2d>& places, std::size_t upper, std::size_t lower) {
  PlaneLine line = fit_plane_line(places, 1e-7);
  if (line.direction.dot(places[lower] - places[upper]) < 0.0) line.direction = -line.direction;
  return line;
}

double inclination(const MotionAxis& axis, const PlaneLine& down) {
  return std::asin(std::clamp(axis.line().direction.dot(down.direction), -1.0, 1.0));
}

}  // namespace

Quantity plumb_angle(const PlumbSetup& setup, const Restitution& restitution, const MotionAxis& axis,
                     std::optional<cv::Size> image_size, const std::vector<ModeAxis>& modes, std::size_t most_pixels) {
  const cv::Mat grey = read_grey_image(setup.view, most_pixels);
  const auto fail = [&](std::string found, std::string expected) {
    throw base::InputError(base::Issue{setup.view.string(), 0, "plumb", std::move(found), std::move(expected)});
  };
  if (image_size && grey.size() != *image_size) {
    fail(fmt::format("{} x {} pixels", grey.cols, grey.rows),
         fmt::format("{} x {} pixels, as the views of the pattern", image_size->width, image_size->height));
  }
  const cv::Rect region(setup.region.x, setup.region.y, setup.region.width, setup.region.height);
  if ((region & cv::Rect(0, 0, grey.cols, grey.rows)) != region) {
    fail(fmt::format("the region [{}, {}, {}, {}]", region.x, region.y, region.width, region.height),
         fmt::format("a region inside the image of {} x {} pixels", grey.cols, grey.rows));
  }
  const auto straight = [&](cv::Point2d pixel) { return restitution.undistorted(pixel); };
  const ThreadInImage thread = find_thread(grey, region, straight);
  std::vector<cv::Point2d> places, turned, centres;
  for (std::size_t i = 0; i < thread.points.size(); ++i) {
    const auto place = restitution.to_plane(thread.points[i]), other = restitution.to_plane(thread.turned[i]);
    if (!place || !other) continue;
    places.push_back(*place);
    turned.push_back(*other);
    centres.push_back(restitution.centre_pixel(*place));
  }
  if (places.size() < kFewestPlaces) fail("no thin straight line in the region", "a dark or bright thread");
  if (!std::isfinite(axis.line().sd_angle_rad)) return undetermined(unknown::NoLineOfMotion{});
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
  return determined(estimate(alpha * base::kDegreesPerRad, std::sqrt(variance) * base::kDegreesPerRad,
                             static_cast<double>(thread.rows) - 2.0));
}

}  // namespace glidelab::core
