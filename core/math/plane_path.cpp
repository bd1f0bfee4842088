#include "core/math/plane_path.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/math/angles.h"
#include "base/math/dense.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kCurveExplains = 0.8;  // of the variance across the path: a smaller share is scatter
constexpr std::size_t kGroups = 16, kFewestOfGroup = 3;
constexpr double kLongPart = 0.125;  // of the length of the path: directions are those of parts as long

/// Sagitta of the parabola through `across` over `along`, whose range is 1; 0 if it explains little of `across`.
double parabola_sagitta(const Eigen::VectorXd& along, const Eigen::VectorXd& across) {
  Eigen::MatrixXd design(along.size(), 3);
  design << Eigen::VectorXd::Ones(along.size()), along, along.cwiseAbs2();
  const Eigen::VectorXd fit = base::least_squares(design, across);
  const Eigen::VectorXd left = across - base::product(design, fit);
  const Eigen::VectorXd about_mean = across.array() - across.mean();
  if (!(left.squaredNorm() < (1.0 - kCurveExplains) * about_mean.squaredNorm())) return 0.0;
  return 0.25 * std::abs(fit[2]);
}

}  // namespace

double sagitta_of(const PlanePath& path) {
  double along_x = 0.0, along_y = 0.0;
  for (std::size_t i = 0; i < path.x_m.size(); ++i) {
    const double dx = path.x_m[i] - path.x_m[0], dy = path.y_m[i] - path.y_m[0];
    if (std::hypot(dx, dy) > std::hypot(along_x, along_y)) along_x = dx, along_y = dy;
  }
  const double length = std::hypot(along_x, along_y);
  if (!(length > 0.0)) return 0.0;
  Eigen::VectorXd place(static_cast<Eigen::Index>(path.x_m.size())), travelled(place.size()), across(place.size());
  for (Eigen::Index i = 0; i < place.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double dx = path.x_m[k] - path.x_m[0], dy = path.y_m[k] - path.y_m[0];
    place[i] = (dx * along_x + dy * along_y) / (length * length);
    across[i] = (dy * along_x - dx * along_y) / (length * length);
    travelled[i] =
        i == 0 ? 0.0 : travelled[i - 1] + std::hypot(path.x_m[k] - path.x_m[k - 1], path.y_m[k] - path.y_m[k - 1]);
  }
  return std::max(parabola_sagitta(place, across),
                  parabola_sagitta(travelled / travelled[travelled.size() - 1], across));
}

double slant_deg(const PlanePath& path) {
  const auto n = static_cast<Eigen::Index>(path.x_m.size());
  Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(path.x_m.data(), n),
                 y = Eigen::Map<const Eigen::ArrayXd>(path.y_m.data(), n);
  x -= x.mean();
  y -= y.mean();
  return 0.5 * std::atan2(2.0 * (x * y).sum(), (x.square() - y.square()).sum()) * base::kDegreesPerRad;
}

namespace {

/// Along the line that fits the path best, and across it.
struct AlongAndAcross {
  std::vector<double> along, across;
};

AlongAndAcross turned(const PlanePath& path) {
  const double angle = slant_deg(path) / base::kDegreesPerRad, c = std::cos(angle), s = std::sin(angle);
  AlongAndAcross turned;
  for (std::size_t i = 0; i < path.x_m.size(); ++i) {
    turned.along.push_back(c * path.x_m[i] + s * path.y_m[i]);
    turned.across.push_back(c * path.y_m[i] - s * path.x_m[i]);
  }
  return turned;
}

double range(std::span<const double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

/// Standard deviation of one value from the second differences of all: 6 times its variance is theirs.
double scatter_of(const std::vector<double>& values) {
  std::vector<double> seconds;
  for (std::size_t i = 2; i < values.size(); ++i) {
    seconds.push_back(std::abs(values[i] - 2.0 * values[i - 1] + values[i - 2]));
  }
  return seconds.empty() ? 0.0 : kSdOverMedian * median_of(seconds) / std::sqrt(6.0);
}

/// The smallest difference between two of the values that differ, where rounding makes half of them or more repeat;
/// otherwise 0.
double step_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double least = std::numeric_limits<double>::infinity();
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[i - 1]) {
      least = std::min(least, values[i] - values[i - 1]);
    } else {
      ++repeated;
    }
  }
  return std::isfinite(least) && 2 * repeated >= values.size() ? least : 0.0;
}

/// By their places along the line.
AlongAndAcross sorted(const AlongAndAcross& line) {
  std::vector<std::size_t> order(line.along.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return line.along[i]; });
  AlongAndAcross result;
  for (const std::size_t i : order) {
    result.along.push_back(line.along[i]);
    result.across.push_back(line.across[i]);
  }
  return result;
}

}  // namespace

PathBend bend_of(const PlanePath& path) {
  const std::size_t n = path.x_m.size();
  if (n < kFewestOfGroup * 2) return {};
  AlongAndAcross line = turned(path);
  PathBend bend;
  bend.length_m = range(line.along);
  if (!(bend.length_m > 0.0)) return {};  // at rest
  bend.noise_m = scatter_of(line.across);
  bend.step_m = std::max(step_of(path.x_m), step_of(path.y_m));
  line = sorted(line);
  const std::size_t groups = std::min(kGroups, n / kFewestOfGroup);
  const auto medians = [&](const std::vector<double>& values) {
    std::vector<double> of_groups;
    for (std::size_t g = 0; g < groups; ++g) {
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(g * n / groups);
      const auto to = values.begin() + static_cast<std::ptrdiff_t>((g + 1) * n / groups);
      of_groups.push_back(median_of(std::vector<double>(from, to)));
    }
    return of_groups;
  };
  const std::vector<double> along = medians(line.along), across = medians(line.across);
  bend.range_m = range(across);
  std::vector<double> slopes_deg;
  for (std::size_t g = 0; g < groups; ++g) {
    std::size_t to = g + 1;
    while (to < groups && std::abs(along[to] - along[g]) < kLongPart * bend.length_m) ++to;
    if (to == groups) continue;
    slopes_deg.push_back(std::atan((across[to] - across[g]) / (along[to] - along[g])) * base::kDegreesPerRad);
  }
  if (!slopes_deg.empty()) bend.slope_deg = range(slopes_deg);
  return bend;
}

}  // namespace glidelab::core
