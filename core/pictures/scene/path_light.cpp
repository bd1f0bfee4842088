#include "core/pictures/scene/path_light.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

#include "base/math/dense.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kNearest = 0.5, kFarthest = 1.5;  // diameters from a frame to those that are compared
constexpr std::size_t kFewestBeside = 2;           // frames
constexpr double kLeastFall = 0.1;                 // of the brighter side
constexpr double kTimesUsual = 5.0, kNormalOfMedian = 1.48;
constexpr std::size_t kFewestChanges = 10, kFewestPoints = 40;
constexpr double kShortestPath = 2.0;  // diameters

/// First and last point of a pass: x rises or falls throughout, but for noise.
struct Pass {
  std::size_t first = 0, last = 0;
};

/// A pass ends where x turns back by half a diameter from its farthest place.
std::vector<Pass> passes_of(const std::vector<LitPoint>& points, double diameter_m) {
  std::vector<Pass> passes;
  std::size_t first = 0, farthest = 0;
  int direction = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double from_first = points[i].x_m - points[first].x_m;
    if (direction == 0 && std::abs(from_first) > kNearest * diameter_m) direction = from_first > 0.0 ? 1 : -1;
    if (direction == 0 || direction * (points[i].x_m - points[farthest].x_m) >= 0.0) {
      farthest = i;
      continue;
    }
    if (direction * (points[farthest].x_m - points[i].x_m) < kNearest * diameter_m) continue;
    passes.push_back({first, farthest});
    first = farthest;
    farthest = i;
    direction = -direction;
  }
  if (!points.empty()) passes.push_back({first, points.size() - 1});
  return passes;
}

struct Change {
  std::size_t at = 0;  ///< point
  double size = 0.0;   ///< of ln(level), towards larger x
};

std::vector<Change> changes_along(const std::vector<LitPoint>& points, const Pass& pass, double diameter_m) {
  std::vector<Change> changes;
  std::vector<double> logs;
  for (const LitPoint& point : points) logs.push_back(std::log(point.level));
  for (std::size_t i = pass.first; i <= pass.last; ++i) {
    double before = 0.0, after = 0.0;
    std::size_t many_before = 0, many_after = 0;
    for (std::size_t k = pass.first; k <= pass.last; ++k) {
      const double off = (points[k].x_m - points[i].x_m) / diameter_m;
      if (std::abs(off) < kNearest || std::abs(off) > kFarthest) continue;
      (off < 0.0 ? before : after) += logs[k];
      ++(off < 0.0 ? many_before : many_after);
    }
    if (many_before < kFewestBeside || many_after < kFewestBeside) continue;
    changes.push_back({i, after / static_cast<double>(many_after) - before / static_cast<double>(many_before)});
  }
  return changes;
}

}  // namespace

std::vector<LightEdge> edges_of_light(const std::vector<LitPoint>& points, double diameter_m) {
  const std::vector<Pass> passes = passes_of(points, diameter_m);
  std::vector<std::vector<Change>> changes;
  std::vector<double> sizes, off;
  for (const Pass& pass : passes) {
    changes.push_back(changes_along(points, pass, diameter_m));
    for (const Change& change : changes.back()) sizes.push_back(change.size);
  }
  if (sizes.size() < kFewestChanges) return {};
  const double median = median_of(sizes);
  for (const double size : sizes) off.push_back(std::abs(size - median));
  const double least = std::max(-std::log(1.0 - kLeastFall), kTimesUsual * kNormalOfMedian * median_of(off));
  std::vector<LightEdge> edges;
  for (std::size_t p = 0; p < passes.size(); ++p) {
    for (const Change& change : changes[p]) {
      const double here_m = points[change.at].x_m;
      if (std::abs(change.size - median) < least) continue;
      const bool largest = std::ranges::all_of(changes[p], [&](const Change& other) {
        const bool near = std::abs(points[other.at].x_m - here_m) <= diameter_m;
        return !near || std::abs(other.size) < std::abs(change.size) || other.at == change.at ||
               (std::abs(other.size) == std::abs(change.size) && other.at > change.at);
      });
      if (!largest) continue;
      LightEdge edge{here_m, 1.0 - std::exp(-std::abs(change.size)), change.size < 0.0, points[change.at].frame,
                     points[change.at].frame};
      for (std::size_t k = passes[p].first; k <= passes[p].last; ++k) {
        if (std::abs(points[k].x_m - here_m) > kNearest * diameter_m) continue;
        edge.first_frame = std::min(edge.first_frame, points[k].frame);
        edge.last_frame = std::max(edge.last_frame, points[k].frame);
      }
      edges.push_back(edge);
    }
  }
  return edges;
}

std::optional<LightSlope> slope_of_light(const std::vector<std::vector<LitPoint>>& clips,
                                         const std::vector<double>& edges_m, double diameter_m) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  Eigen::Index many = 0;
  for (const auto& clip : clips) {
    many += std::ssize(clip);
    for (const LitPoint& point : clip) {
      low = std::min(low, point.x_m);
      high = std::max(high, point.x_m);
    }
  }
  const double half = 0.5 * (high - low);
  if (many < static_cast<Eigen::Index>(kFewestPoints) || !(2.0 * half > kShortestPath * diameter_m))
    return std::nullopt;
  const Eigen::Index steps = std::ssize(edges_m), of_clips = std::ssize(clips), columns = of_clips + steps + 2;
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(many, columns);
  Eigen::VectorXd data(many);
  Eigen::Index row = 0;
  for (Eigen::Index c = 0; c < of_clips; ++c) {
    for (const LitPoint& point : clips[static_cast<std::size_t>(c)]) {
      const double s = (point.x_m - 0.5 * (low + high)) / half;
      design(row, c) = 1.0;
      for (Eigen::Index e = 0; e < steps; ++e) {
        const double off = (point.x_m - edges_m[static_cast<std::size_t>(e)]) / diameter_m;
        design(row, of_clips + e) = std::clamp(off, -0.5, 0.5);
      }
      design(row, columns - 2) = s;
      design(row, columns - 1) = s * s;
      data[row++] = std::log(point.level);
    }
  }
  Eigen::MatrixXd normal = base::transposed_product(design, design);
  normal.diagonal().array() += 1e-9 * normal.diagonal().maxCoeff();
  const Eigen::MatrixXd inverse = base::inverse_positive(normal);
  const Eigen::VectorXd found = base::product(inverse, base::transposed_product(design, data));
  const double slope = found[columns - 2], bend = found[columns - 1];
  if (std::abs(bend) > std::abs(slope)) return std::nullopt;
  const double variance = (data - base::product(design, found)).squaredNorm() / static_cast<double>(many);
  const double independent = std::min(1.0, 2.0 * half / diameter_m / static_cast<double>(many));
  return LightSlope{slope / half, std::sqrt(variance * inverse(columns - 2, columns - 2) / independent) / half};
}

}  // namespace glidelab::core
