#include "core/pictures/camera/motion_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "base/errors.h"
#include "core/math/block_scatter.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr int kMostReweightings = 30;
constexpr double kTukeyCutoff = 6.0;  // scaled median deviations; 99 % efficient for Gaussian residuals
// Anything above zero keeps exact data's weights defined; a tenth of a micrometre is below any camera.
constexpr double kLeastScale = 1e-7;

/// One point of every small cell, so that a marker that rests does not outvote its motion; at most about 80.
std::vector<cv::Point2d> thinned(const std::vector<cv::Point2d>& points) {
  cv::Point2d low = points.front(), high = points.front();
  for (const cv::Point2d& point : points) {
    low = {std::min(low.x, point.x), std::min(low.y, point.y)};
    high = {std::max(high.x, point.x), std::max(high.y, point.y)};
  }
  const double cell = std::max(high.x - low.x, high.y - low.y) / 60.0;
  std::set<std::pair<long, long>> taken;
  std::vector<cv::Point2d> kept;
  for (const cv::Point2d& point : points) {
    if (!(cell > 0.0)) break;
    if (!taken.emplace(std::lround((point.x - low.x) / cell), std::lround((point.y - low.y) / cell)).second) continue;
    kept.push_back(point);
  }
  return kept;
}

/// The line through two of the points that minimises the median distance: half of the points may lie anywhere.
std::optional<PlaneLine> least_median_line(const std::vector<cv::Point2d>& points) {
  const std::vector<cv::Point2d> few = thinned(points);
  std::optional<PlaneLine> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < few.size(); ++i) {
    for (std::size_t j = i + 1; j < few.size(); ++j) {
      PlaneLine line;
      line.through = few[i];
      line.direction = (few[j] - few[i]) / cv::norm(few[j] - few[i]);
      std::vector<double> distances;
      for (const cv::Point2d& point : few) distances.push_back(std::abs(line.across(point)));
      const double median = median_of(distances);
      if (median >= least) continue;
      least = median;
      best = line;
    }
  }
  return best;
}

/// Variance of the direction by the scatter of blocks of points along the line, with the scores w l e, over what
/// independent points give (block_scatter.h). 1 where it is not significantly above that.
double excess_of_blocks(const PlaneLine& line, const std::vector<cv::Point2d>& points,
                        const std::vector<double>& weights) {
  constexpr std::size_t kFewestInBlock = 3;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (weights[i] > 0.0) order.push_back(i);
  }
  if (order.size() < kScatterBlocks * kFewestInBlock) return 1.0;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return line.along(points[a]) < line.along(points[b]); });
  double independent = 0.0;
  const double scatter = scatter_of_blocks(order.size(), [&](std::size_t k) {
    const std::size_t i = order[k];
    const double score = weights[i] * line.along(points[i]) * line.across(points[i]);
    independent += score * score;
    return score;
  });
  return independent > 0.0 ? excess_over_independent(scatter, independent) : 1.0;
}

/// Fits the points that lie near the start; all points if there is no start.
PlaneLine fit_from(const std::optional<PlaneLine>& start, const std::vector<cv::Point2d>& points, double least_scale) {
  if (points.empty()) throw base::NumericalError("no points to fit a line to");
  std::vector<double> weights(points.size(), 1.0);
  if (start) {
    std::vector<double> distances;
    for (const cv::Point2d& point : points) distances.push_back(std::abs(start->across(point)));
    // A generous scale: the line through two noisy points is itself off by some noise.
    const double scale = std::max(3.0 * kSdOverMedian * median_of(distances), least_scale);
    for (std::size_t i = 0; i < points.size(); ++i) weights[i] = distances[i] < kTukeyCutoff * scale ? 1.0 : 0.0;
  }
  PlaneLine line;
  for (int iteration = 0; iteration < kMostReweightings; ++iteration) {
    double sum = 0.0;
    cv::Point2d mean;
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum += weights[i];
      mean += weights[i] * points[i];
    }
    mean /= sum;
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const cv::Point2d off = points[i] - mean;
      xx += weights[i] * off.x * off.x;
      xy += weights[i] * off.x * off.y;
      yy += weights[i] * off.y * off.y;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    const PlaneLine before = line;
    line.through = mean;
    line.direction = {std::cos(angle), std::sin(angle)};
    double length2 = 0.0, across2 = 0.0, lever2 = 0.0;
    std::vector<double> distances;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double across = line.across(points[i]);
      length2 = std::max(length2, std::pow(line.along(points[i]), 2));
      lever2 += weights[i] * std::pow(line.along(points[i]), 2);
      across2 += weights[i] * across * across;
      distances.push_back(std::abs(across));
    }
    if (!(length2 > 0.0)) throw base::NumericalError("the points of a line all lie in one place");
    const double scale = std::max(kSdOverMedian * median_of(distances), least_scale);
    line.used = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double share = distances[i] / (kTukeyCutoff * scale);
      weights[i] = share < 1.0 ? std::pow(1.0 - share * share, 2) : 0.0;
      if (weights[i] > 0.5) ++line.used;
    }
    line.rms_across = std::sqrt(across2 / sum);
    line.sd_angle_rad = line.rms_across / std::sqrt(lever2);
    if (iteration > 0 && cv::norm(line.direction - before.direction) < 1e-14 &&
        cv::norm(line.through - before.through) <= 1e-14 * std::sqrt(length2)) {
      break;
    }
  }
  line.sd_angle_rad *= std::sqrt(excess_of_blocks(line, points, weights));
  return line;
}

}  // namespace

PlaneLine fit_plane_line(const std::vector<cv::Point2d>& points, double least_scale) {
  return fit_from(points.empty() ? std::nullopt : least_median_line(points), points, least_scale);
}

namespace {

/// Of length 1, in the plane.
cv::Point2d towards(Downhill downhill) {
  const double sign = sign_of(downhill);
  return is_along_y(downhill) ? cv::Point2d(0.0, sign) : cv::Point2d(sign, 0.0);
}

}  // namespace

MotionAxis MotionAxis::directed(const PlaneLine& line, Downhill downhill) {
  MotionAxis axis;
  axis.line_ = line;
  if (axis.line_.direction.dot(towards(downhill)) < 0.0) axis.line_.direction = -axis.line_.direction;
  return axis;
}

MotionAxis MotionAxis::through(const std::vector<cv::Point2d>& points, Downhill downhill) {
  return directed(fit_plane_line(points, kLeastScale), downhill);
}

MotionAxis MotionAxis::moved_through(const std::vector<cv::Point2d>& points, Downhill downhill) const {
  return directed(fit_from(line_, points, kLeastScale), downhill);
}

MotionAxis MotionAxis::along(Downhill downhill) {
  MotionAxis axis;
  axis.line_.direction = towards(downhill);
  axis.line_.sd_angle_rad = std::numeric_limits<double>::infinity();
  return axis;
}

MotionAxis MotionAxis::turned(const MotionAxis& to, const MotionAxis& from) const {
  const double cosine = from.line_.direction.dot(to.line_.direction);
  const double sine = from.line_.direction.cross(to.line_.direction);
  MotionAxis axis = *this;
  const cv::Point2d d = line_.direction;
  axis.line_.direction = {cosine * d.x - sine * d.y, sine * d.x + cosine * d.y};
  return axis;
}

double MotionAxis::angle_to_x_rad() const {
  return std::atan(line_.direction.y / line_.direction.x);
}

namespace {

constexpr std::size_t kMostPlacesUsed = 1500;  // places say how a smooth displacement turns the line

}  // namespace

std::vector<double> ModeAxis::displacement(const Restitution& restitution, const MotionAxis& without,
                                           const std::vector<cv::Point2d>& places) const {
  std::vector<double> change;
  change.reserve(places.size());
  for (const cv::Point2d& place : places) {
    const auto moved = mode.to_plane(restitution.centre_pixel(place));
    change.push_back(moved ? (axis.x_of(*moved) - without.x_of(place)) / mode.sds : 0.0);
  }
  return change;
}

std::vector<ModeAxis> mode_axes(const Restitution& restitution, const MotionAxis& without,
                                const std::vector<cv::Point2d>& places, Downhill downhill) {
  const std::size_t stride = places.size() / kMostPlacesUsed + 1;
  std::vector<cv::Point2d> some, pixels;
  for (std::size_t i = 0; i < places.size(); i += stride) {
    some.push_back(places[i]);
    pixels.push_back(restitution.centre_pixel(places[i]));
  }
  const bool moves = std::isfinite(without.line().sd_angle_rad);  // else the marker rests, and x runs along X
  const MotionAxis before = moves && stride > 1 ? without.moved_through(some, downhill) : without;
  std::vector<ModeAxis> axes;
  for (const RestitutionMode& mode : restitution.modes()) {
    ModeAxis moved{mode, without};
    if (moves) {
      std::vector<cv::Point2d> displaced;
      for (std::size_t i = 0; i < some.size(); ++i) displaced.push_back(mode.to_plane(pixels[i]).value_or(some[i]));
      moved.axis = without.turned(before.moved_through(displaced, downhill), before);
    }
    axes.push_back(moved);
  }
  return axes;
}

}  // namespace glidelab::core
