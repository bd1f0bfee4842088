// Rules that examine how a changes with the bandwidth, point by point.
//
//   ebbs  Ruppert 1997 (J. Am. Stat. Assoc. 92, 1049): at each point the estimates a(t; h) of nine neighbouring
//         bandwidths are fitted by c_0 + c_1 h^2; c_1 h^2 is the bias at h, and the mean over points of variance +
//         bias^2 is minimised. The variance is exact for the estimated noise, correlated or not.
//   ici   Intersection of confidence intervals (Goldenshluger and Nemirovski 1997; Katkovnik 1999): at each point the
//         widest h for which all a(t; h') +- kIciWidth sd(h'), h' <= h, have a value in common. Local: h varies along
//         the motion. Theory gives the width's order, not its value: with bias ~ h^2 and sd ~ h^-2.5 (their ratio at
//         the best h is sqrt(5)/2) the intervals, apart from their noise, separate at the best h for a width of 0.17,
//         and at 1.6 times it for 1.25; but narrow ones separate by chance long before. 1.25 was chosen on a glider
//         that slows down (tests/core/motion/bandwidth/test_bandwidth_rule.cpp), and serves the other motions there.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/quantile.h"
#include "core/motion/bandwidth/bandwidth_rule.h"

namespace glidelab::core {
namespace {

constexpr double kIciWidth = 1.25;  // standard deviations

/// a and its variance at every probe (inner) for every bandwidth (outer) of the grid; if a kernel holds too few points,
/// the variance is infinite.
struct Estimates {
  std::vector<std::vector<double>> a, variance;
};

Estimates estimates_of(const BandwidthScan& scan) {
  Estimates estimates;
  for (const double h : scan.grid()) {
    const std::vector<LocalPolynomial> smoothers = scan.smoothers(h);
    RowVariance variance(scan.problem().noise.autocovariance);
    auto& a = estimates.a.emplace_back();
    auto& of_a = estimates.variance.emplace_back();
    for (const Probe& probe : scan.probes()) {
      scan.problem().stop_check();
      const auto row = smoothers[probe.part].row_of_point(probe.point);
      a.push_back(row ? weighted_sums(*row, scan.problem().parts[probe.part].x_m).a_m_s2 : 0.0);
      of_a.push_back(row ? variance.of_a(*row) : std::numeric_limits<double>::infinity());
    }
  }
  return estimates;
}

/// c_1 h^2 of c_0 + c_1 h^2 by least squares through the bandwidths from … to - 1.
double empirical_bias(const std::vector<double>& grid, const Estimates& estimates, std::size_t from, std::size_t to,
                      std::size_t at, std::size_t probe) {
  double n = 0.0, s = 0.0, a = 0.0, ss = 0.0, sa = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    const double square = grid[i] * grid[i] / (grid[at] * grid[at]);
    n += 1.0;
    s += square;
    a += estimates.a[i][probe];
    ss += square * square;
    sa += square * estimates.a[i][probe];
  }
  return (sa - s * a / n) / (ss - s * s / n);
}

std::optional<BandwidthPick> by_empirical_bias(const BandwidthProblem& problem) {
  constexpr std::size_t kEachSide = 4;
  const BandwidthScan scan(problem);
  const std::vector<double>& grid = scan.grid();
  if (grid.size() <= 2 * kEachSide || scan.probes().empty()) return {};
  const Estimates estimates = estimates_of(scan);
  std::vector<double> criterion(grid.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = kEachSide; i + kEachSide < grid.size(); ++i) {
    double sum = 0.0;
    for (std::size_t p = 0; p < scan.probes().size(); ++p) {
      const double bias = empirical_bias(grid, estimates, i - kEachSide, i + kEachSide + 1, i, p);
      sum += bias * bias + estimates.variance[i][p];
    }
    criterion[i] = std::isfinite(sum) ? sum : std::numeric_limits<double>::quiet_NaN();
  }
  const auto best = least(criterion);
  if (!best) return {};
  BandwidthPick pick;
  pick.bandwidth_s = grid[*best];
  pick.by = found_by_rule("empirical bias: noise and bias of a together {:.2g} m/s^2",
                          std::sqrt(criterion[*best] / static_cast<double>(scan.probes().size())));
  const std::vector<double> judged(grid.begin() + kEachSide, grid.end() - kEachSide);
  pick.by.edge = edge_of(judged, *best - kEachSide);
  return pick;
}

std::optional<BandwidthPick> by_intersection(const BandwidthProblem& problem) {
  const BandwidthScan scan(problem);
  const std::vector<double>& grid = scan.grid();
  if (grid.empty() || scan.probes().empty()) return {};
  const Estimates estimates = estimates_of(scan);
  BandwidthPick pick;
  std::vector<double> taken_s;
  std::size_t widest = 0;
  for (std::size_t p = 0; p < scan.probes().size(); ++p) {
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    std::size_t taken = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const double half = kIciWidth * std::sqrt(estimates.variance[i][p]);
      low = std::max(low, estimates.a[i][p] - half);
      high = std::min(high, estimates.a[i][p] + half);
      if (low > high) break;
      taken = i;
    }
    if (taken + 1 == grid.size()) ++widest;
    pick.local.push_back({scan.time(scan.probes()[p]), grid[taken]});
    taken_s.push_back(grid[taken]);
  }
  pick.bandwidth_s = quantile(taken_s, 0.5);
  const auto [low, high] = std::minmax_element(taken_s.begin(), taken_s.end());
  pick.by =
      found_by_rule("intersection of confidence intervals: median of {:.1f} to {:.1f} ms", 1e3 * *low, 1e3 * *high);
  if (2 * widest > taken_s.size()) pick.by.edge = chosen_by::Rule::Edge::widest;
  return pick;
}

}  // namespace

extern const BandwidthRule kEmpiricalBias = {
    "ebbs", "empirical bias: estimates the bias from the drift of a at each point as h grows",
    "the bias is proportional to h²", by_empirical_bias};
extern const BandwidthRule kIntersectionOfIntervals = {
    "ici",
    "widens h at each point until the confidence intervals of a no longer agree; takes the median over the points",
    "the noise is known", by_intersection};

}  // namespace glidelab::core
