// rsc: the residual squares criterion of Fan and Gijbels 1995 (J. R. Stat. Soc. B 57, 371), the mean over points of
//
//     RSC(t; h) = s^2(t) (1 + 4 V),   s^2(t) = sum K_i r_i^2 / tr(K - K X (X'KX)^-1 X'K),   V = sum w_i^2,
//
// with r the residuals of the local cubic about t and w its weights for x; its minimum times 0.829 is the h for a.
#include <cmath>
#include <limits>

#include "core/math/least_squares.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {
namespace {

constexpr int kCubic = 3;

/// RSC at one point; NaN if the kernel holds too few points.
double residual_squares(const MotionPart& part, std::size_t point, double bandwidth_s) {
  const double at = part.t_s[point], reach = kKernelReach * bandwidth_s;
  std::vector<double> u, kernel, x;
  std::size_t from = point;
  while (from > 0 && at - part.t_s[from - 1] <= reach) --from;
  for (std::size_t i = from; i < part.t_s.size() && part.t_s[i] - at <= reach; ++i) {
    u.push_back((part.t_s[i] - at) / bandwidth_s);
    kernel.push_back(kernel_value(Kernel::gaussian, u.back()));
    x.push_back(part.x_m[i] - part.x_m[point]);
  }
  const auto basis = OrthogonalPolynomials::make(kCubic, u, kernel);
  if (u.size() < kCubic + 2 || !basis) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> at_zero = basis->derivatives(0.0, 0);
  double squares = 0.0, trace = 0.0, variance = 0.0;
  std::vector<double> fit(u.size(), 0.0), weight(u.size(), 0.0);
  for (int k = 0; k <= kCubic; ++k) {
    const auto p = basis->at_points(k);
    double projection = 0.0, own = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      projection += kernel[i] * p[i] * x[i];
      own += kernel[i] * kernel[i] * p[i] * p[i];
    }
    trace -= own / basis->norm(k);
    for (std::size_t i = 0; i < u.size(); ++i) {
      fit[i] += projection / basis->norm(k) * p[i];
      weight[i] += at_zero[static_cast<std::size_t>(k)] * kernel[i] * p[i] / basis->norm(k);
    }
  }
  for (std::size_t i = 0; i < u.size(); ++i) {
    squares += kernel[i] * (x[i] - fit[i]) * (x[i] - fit[i]);
    trace += kernel[i];
    variance += weight[i] * weight[i];
  }
  return squares / trace * (1.0 + (kCubic + 1) * variance);
}

std::optional<BandwidthPick> by_residual_squares(const BandwidthProblem& problem) {
  const BandwidthScan scan(problem);
  std::vector<double> criterion;
  for (const double h : scan.grid()) {
    double sum = 0.0;
    for (const Probe& probe : scan.probes()) {
      problem.stop_check();
      sum += residual_squares(problem.parts[probe.part], probe.point, h);
    }
    criterion.push_back(scan.probes().empty() ? std::numeric_limits<double>::quiet_NaN() : sum);
  }
  const auto best = least(criterion);
  if (!best) return {};
  const double found = scan.grid()[*best];
  BandwidthPick pick;
  pick.bandwidth_s = found * std::pow(kGaussianA.best_h9() / kResidualSquaresH9, 1.0 / 9.0);
  pick.by = found_by_rule("residual squares criterion: minimum at {:.1f} ms", 1e3 * found);
  pick.by.edge = edge_of(scan.grid(), *best);
  pick.by.converted = true;
  return pick;
}

}  // namespace

extern const BandwidthRule kResidualSquares = {
    "rsc", "residual squares criterion: how far points lie off their local cubic, and how little that cubic averages",
    "white noise", by_residual_squares};

}  // namespace glidelab::core
