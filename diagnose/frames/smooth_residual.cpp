#include "diagnose/frames/smooth_residual.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "base/math/dense.h"

namespace glidelab::diagnose {
namespace {

constexpr std::array kPointsABump = {14.0, 10.0, 7.0, 5.0};  // of the smooth curve
constexpr double kFewestBumps = 4.0;
constexpr double kMostOffCurve = 5.0;  // standard deviations
constexpr double kTwoSd = 2.0;         // of the sum of neighbours' products, where they err by chance

struct UnderCurve {
  Eigen::VectorXd rest;  // of all points
  Eigen::Index bumps = 0;
};

/// What a least-squares curve of bumps, one to so many points, leaves of `r`; outliers do not count. Bumps stand before
/// the first point and behind the last as well: without them the curve would bend away there.
UnderCurve left_by_curve(const TrackedMotion& data, const Eigen::VectorXd& r, double points_a_bump) {
  const Eigen::Index n = r.size();
  const auto parts = static_cast<Eigen::Index>(std::max(kFewestBumps, static_cast<double>(n) / points_a_bump)) - 1;
  const double span = data.t_s.back() - data.t_s.front(), width = span / static_cast<double>(parts);
  const Eigen::Index bumps = parts + 3;
  Eigen::MatrixXd basis(n, bumps);
  for (Eigen::Index p = 0; p < n; ++p) {
    for (Eigen::Index b = 0; b < bumps; ++b) {
      const double z = (data.t_s[static_cast<std::size_t>(p)] - data.t_s.front()) / width - static_cast<double>(b - 1);
      basis(p, b) = std::abs(z) < 4.0 ? std::exp(-0.5 * z * z) : 0.0;
    }
  }
  Eigen::VectorXd rest = r;
  std::vector<char> out = data.outlier;
  for (int round = 0; round < 3; ++round) {
    Eigen::MatrixXd kept = basis;
    Eigen::VectorXd of = r;
    for (Eigen::Index p = 0; p < n; ++p) {
      if (!out[static_cast<std::size_t>(p)]) continue;
      kept.row(p).setZero();
      of[p] = 0.0;
    }
    Eigen::MatrixXd normal = base::transposed_product(kept, kept);
    normal.diagonal().array() += 1e-9 * normal.diagonal().maxCoeff();
    rest = r - base::product(basis, base::solve_positive(normal, base::transposed_product(kept, of)));
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto q = static_cast<std::size_t>(p);
      out[q] = std::abs(rest[p]) * data.sd_m > kMostOffCurve * data.sd_of(q) ? 1 : 0;
    }
  }
  return {std::move(rest), bumps};
}

/// Whether neighbours err alike by more than chance makes; a single one that is far off says nothing of that.
bool lasts(const TrackedMotion& data, const Eigen::VectorXd& rest) {
  double products = 0.0, squares = 0.0, pairs = 0.0;
  const auto clipped = [&](Eigen::Index p) {
    const double wider = data.sd_of(static_cast<std::size_t>(p)) / data.sd_m;
    return std::clamp(rest[p] / wider, -kMostOffCurve, kMostOffCurve);
  };
  for (Eigen::Index p = 0; p + 1 < rest.size(); ++p) {
    if (data.outlier[static_cast<std::size_t>(p)] || data.outlier[static_cast<std::size_t>(p) + 1]) continue;
    products += clipped(p) * clipped(p + 1);
    squares += 0.5 * (clipped(p) * clipped(p) + clipped(p + 1) * clipped(p + 1));
    pairs += 1.0;
  }
  return pairs > 0.0 && products * std::sqrt(pairs) > kTwoSd * squares;
}

}  // namespace

Leftover leftover_of(const TrackSet& set, const MotionFit& fit, std::size_t motion) {
  const TrackedMotion& data = set.motions[motion];
  const Moved moved = move(model_of(set, *fit.layout, fit.at, motion), data.t_s,
                           fit.late.empty() ? std::span<const double>() : std::span(fit.late[motion]));
  const std::vector<double> shared = shared_errors(set, *fit.layout, fit.at, motion, moved.x_m);
  const auto n = static_cast<Eigen::Index>(data.t_s.size());
  Eigen::VectorXd r(n);
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto q = static_cast<std::size_t>(p);
    r[p] = (data.x_m[q] - moved.x_m[q] - shared[q]) / data.sd_m;
  }
  UnderCurve under;
  for (const double points : kPointsABump) {
    under = left_by_curve(data, r, points);
    if (!lasts(data, under.rest)) break;
  }
  const double taken = std::sqrt(1.0 - std::min(0.5, static_cast<double>(under.bumps) / static_cast<double>(n)));
  Leftover left;
  left.v_m_s = moved.v_m_s;
  for (Eigen::Index p = 0; p < n; ++p) {
    left.over_sd.push_back(under.rest[p] * data.sd_m / data.sd_of(static_cast<std::size_t>(p)) / taken);
  }
  return left;
}

}  // namespace glidelab::diagnose
