#include "diagnose/fit/nominal_fit.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/math/dense.h"
#include "diagnose/fit/integrated_start.h"

namespace glidelab::diagnose {
namespace {

constexpr int kMoreRounds = 2;  // further rounds of iterations, for a nominal fit that has not converged

/// x0 and v0 by a parabola through the first points; points that were set aside are left out if enough others remain.
Eigen::VectorXd start_of(const TrackedMotion& motion) {
  constexpr std::size_t kStartPoints = 25, kFewestStartPoints = 6;
  std::vector<std::size_t> points;
  for (std::size_t p = 0; p < motion.t_s.size() && points.size() < kStartPoints; ++p) {
    if (!motion.outlier[p]) points.push_back(p);
  }
  if (points.size() < kFewestStartPoints) {
    points.resize(std::min(motion.t_s.size(), kStartPoints));
    std::iota(points.begin(), points.end(), std::size_t{0});
  }
  Eigen::MatrixXd design(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::VectorXd x(design.rows());
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const std::size_t p = points[static_cast<std::size_t>(i)];
    const double t = motion.t_s[p] - motion.t_s.front();
    design.row(i) << 1.0, t, t * t;
    x[i] = motion.x_m[p];
  }
  const Eigen::VectorXd fit = base::least_squares(design, x);
  return fit.head(2);
}

/// Downwards, over all motions.
double mean_speed(const TrackSet& set) {
  double distance_m = 0.0, time_s = 0.0;
  for (const TrackedMotion& motion : set.motions) {
    distance_m += motion.x_m.back() - motion.x_m.front();
    time_s += motion.t_s.back() - motion.t_s.front();
  }
  return distance_m / time_s;
}

}  // namespace

MotionFit fit_nominal(const TrackSet& set, const Lateness& late) {
  const ParameterLayout layout(set, {});
  MotionFit best;
  best.cost = std::numeric_limits<double>::infinity();
  double mass = 0.0;
  std::size_t points = 0;
  for (const TrackedMotion& motion : set.motions) {
    mass += set.masses[motion.mass].mass_kg;
    points += motion.t_s.size();
  }
  mass /= static_cast<double>(set.motions.size());
  const auto fit_if_better = [&](const FitPoint& start) {
    MotionFit fit = fit_motions(set, {}, start, late);
    if (fit.cost < 0.999 * best.cost) best = std::move(fit);
    return best.converged && best.cost < 4.0 * static_cast<double>(points);  // other starts find nothing better
  };
  const auto from_statements = [&](double k_over_m) {
    FitPoint start;
    start.global = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(layout.globals().size()));
    start.global[0] = k_over_m * mass;
    start.global[1] = only_falls(set) ? 0.0 : 0.005;
    for (std::size_t g = 0; g < set.groups.size(); ++g) {
      start.global[static_cast<Eigen::Index>(2 + g)] = set.groups[g].stated_rad;
    }
    for (const TrackedMotion& motion : set.motions) start.own.push_back(start_of(motion));
    return start;
  };
  if (!fit_if_better(integrated_start(set))) {
    for (const double k_over_m : {1.0, 3.0, 0.1}) {
      if (fit_if_better(from_statements(k_over_m))) break;
    }
  }
  // A body that sinks at one speed may be borne by a liquid, or by a drag that stops it within a few positions.
  if (set.weight_open && mean_speed(set) > 0.0) fit_if_better(from_statements(set.gravity_m_s2 / mean_speed(set)));
  for (int more = 0; more < kMoreRounds && std::isfinite(best.cost) && !best.converged; ++more) {
    best = fit_motions(set, {}, best.at, late);
  }
  if (!std::isfinite(best.cost)) {
    throw base::NumericalError(
        "the nominal model cannot be fitted to these positions: the fit makes no progress from any starting point");
  }
  return best;
}

}  // namespace glidelab::diagnose
