#include "core/pictures/camera/plumb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "core/pictures/camera/thread_search.h"
#include "core/pictures/frames/read_image.h"
#include "core/result/estimate.h"

namespace glidelab::core {
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
                     std::optional<cv::Size> image_size, const std::vector<ModeAxis>& modes) {
  const cv::Mat grey = read_grey_image(setup.view);
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
