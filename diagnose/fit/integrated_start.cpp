#include "diagnose/fit/integrated_start.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <vector>

#include "base/math/dense.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {
namespace {

// Negligible beside the positions: these priors decide only what the positions leave undetermined.
constexpr double kOpenRate = 30.0;     // 1/s, sd of K/m
constexpr double kOpenFriction = 0.3;  // sd of mu

/// Running integral by the trapezoidal rule, starting at 0.
std::vector<double> integral(const std::vector<double>& t_s, const std::vector<double>& y) {
  std::vector<double> sum(y.size(), 0.0);
  for (std::size_t p = 1; p < y.size(); ++p) sum[p] = sum[p - 1] + 0.5 * (y[p] + y[p - 1]) * (t_s[p] - t_s[p - 1]);
  return sum;
}

/// The direction of motion (the sign of v) at each position; constant between turns.
std::vector<double> directions(const TrackedMotion& motion) {
  std::vector<std::size_t> ends = turns_of(motion);
  ends.push_back(motion.x_m.size() - 1);
  std::vector<double> direction(motion.x_m.size(), 0.0);
  std::size_t from = 0;
  for (const std::size_t to : ends) {
    const double displacement = motion.x_m[to] - motion.x_m[from];
    for (std::size_t p = from; p <= to; ++p) direction[p] = displacement > 0.0 ? 1.0 : displacement < 0.0 ? -1.0 : 0.0;
    from = to;
  }
  return direction;
}

/// The recorded force at each position's time, linear between its samples.
std::vector<double> force_at(const TrackedMotion& motion) {
  const KnownForce& known = motion.known;
  std::vector<double> force;
  std::size_t after = 0;
  for (const double t : motion.t_s) {
    while (after < known.t_s.size() && known.t_s[after] <= t) ++after;
    if (after == 0 || after == known.t_s.size()) {
      force.push_back(known.force_n[after == 0 ? 0 : after - 1]);
      continue;
    }
    const double part = (t - known.t_s[after - 1]) / (known.t_s[after] - known.t_s[after - 1]);
    force.push_back(known.force_n[after - 1] + part * (known.force_n[after] - known.force_n[after - 1]));
  }
  return force;
}

/// A force of unit size that depends on position alone.
struct PlacedForce {
  std::size_t effect = 0;
  double place_m = 0.0;
};

/// That force at each position.
std::vector<double> force_at(const TrackSet& set, const TrackedMotion& motion, const PlacedForce& force) {
  const std::array<double, 2> values{1.0, force.place_m};
  GliderConstants glider;
  glider.mass_kg = set.masses[motion.mass].mass_kg;
  glider.x_mid_all_m = set.x_mid_m;
  std::vector<double> force_n;
  for (const double x : motion.x_m) {
    force_n.push_back(effect_list()[force.effect].law.force_n(values.data(), glider, {x, 0.0, 0.0, 0.0, false}));
  }
  return force_n;
}

/// A motion's positions and their derivatives with respect to the parameters, divided by the noise.
struct Integrated {
  Eigen::MatrixXd common;  ///< with respect to K, mu, sin(alpha) of its group, and the size of a force
  Eigen::MatrixXd own;     ///< with respect to x0, v0
  Eigen::VectorXd x;
};

Integrated integrated(const TrackSet& set, const TrackedMotion& motion, const std::optional<PlacedForce>& force) {
  const double mass = set.masses[motion.mass].mass_kg, g = set.gravity_m_s2;
  const double normal = g * std::cos(set.groups[motion.group].stated_rad);
  const auto count = motion.t_s.size();
  std::vector<double> displacement(count), driven(count, 0.0);
  for (std::size_t p = 0; p < count; ++p) displacement[p] = motion.x_m[p] - motion.x_m.front();
  const std::vector<double> path = integral(motion.t_s, displacement);
  const std::vector<double> sign = integral(motion.t_s, integral(motion.t_s, directions(motion)));
  if (!motion.known.t_s.empty()) driven = integral(motion.t_s, integral(motion.t_s, force_at(motion)));
  std::vector<double> pushed(count, 0.0);
  if (force) pushed = integral(motion.t_s, integral(motion.t_s, force_at(set, motion, *force)));
  Integrated all;
  const auto rows = static_cast<Eigen::Index>(count);
  all.common = Eigen::MatrixXd::Zero(rows, force ? 4 : 3);
  all.own = Eigen::MatrixXd::Zero(rows, 2);
  all.x = Eigen::VectorXd::Zero(rows);
  for (std::size_t p = 0; p < count; ++p) {
    if (motion.outlier[p] != 0) continue;
    const auto row = static_cast<Eigen::Index>(p);
    const double t = motion.t_s[p] - motion.t_s.front(), by = 1.0 / motion.sd_of(p);
    all.common.row(row).head(3) << -by * path[p] / mass, -by * normal * sign[p], 0.5 * by * g * t * t;
    if (force) all.common(row, 3) = by * pushed[p] / mass;
    all.own.row(row) << by, by * t;
    all.x[row] = by * (motion.x_m[p] - driven[p] / mass);
  }
  return all;
}

struct Minimum {
  Eigen::VectorXd at;
  double value = 0.0;
};

/// The minimum of y'Ay/2 - b'y with the first two components of y not negative: of the four choices of which of them
/// are held at zero, the best that satisfies this.
Minimum resisting(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, bool frictionless) {
  Minimum best{Eigen::VectorXd::Zero(b.size())};
  for (const std::array<bool, 2> held : {std::array{false, false}, {true, false}, {false, true}, {true, true}}) {
    if (frictionless && !held[1]) continue;
    Eigen::MatrixXd rest = a;
    Eigen::VectorXd right = b;
    for (Eigen::Index k = 0; k < 2; ++k) {
      if (!held[static_cast<std::size_t>(k)]) continue;
      rest.row(k).setZero();
      rest.col(k).setZero();
      rest(k, k) = 1.0;
      right[k] = 0.0;
    }
    const Eigen::VectorXd y = base::solve_positive(rest, right);
    if (!y.allFinite() || y[0] < 0.0 || y[1] < 0.0) continue;
    const Eigen::VectorXd along = base::product(a, y);
    const double value = 0.5 * y.dot(along) - b.dot(y);
    if (value < best.value) best = {y, value};
  }
  return best;
}

double most_of(const TrackSet& set, std::size_t effect) {
  return range_of(set, effect_list()[effect].parameters.front()).high;
}

/// K, mu, sin(alpha) of each group and the size of a force, if there is one, with which the integrated positions agree
/// best.
struct Solved {
  Minimum minimum;
  std::vector<Integrated> motions;
};

Solved solve(const TrackSet& set, const std::optional<PlacedForce>& force) {
  const auto groups = static_cast<Eigen::Index>(set.groups.size());
  const Eigen::Index count = 2 + groups + (force ? 1 : 0);
  double heaviest = 0.0;
  for (const TrackedMass& mass : set.masses) heaviest = std::max(heaviest, mass.mass_kg);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  normal(0, 0) = std::pow(kOpenRate * heaviest, -2);
  normal(1, 1) = std::pow(kOpenFriction, -2);
  if (force) normal(count - 1, count - 1) = std::pow(most_of(set, force->effect), -2);
  for (std::size_t g = 0; g < set.groups.size(); ++g) {
    const TrackGroup& group = set.groups[g];
    const Eigen::Index k = 2 + static_cast<Eigen::Index>(g);
    const auto state = [&](double alpha_rad, double sd_rad) {
      const double sd = std::max(1e-3, sd_rad * std::abs(std::cos(alpha_rad)));
      normal(k, k) += 1.0 / (sd * sd);
      right[k] += std::sin(alpha_rad) / (sd * sd);
    };
    state(group.stated_rad, is_fall(group) ? kFallInclination_rad : kOpenInclination_rad);
    for (const InclineStatement& s : group.statements) state(s.alpha_rad, s.sd_rad);
  }
  Solved solved;
  for (const TrackedMotion& motion : set.motions) {
    solved.motions.push_back(integrated(set, motion, force));
    const Integrated& one = solved.motions.back();
    // Minus the part that its own x0 and v0 can absorb.
    const Eigen::MatrixXd own = base::orthonormal_columns(one.own, 1e-9);
    const Eigen::MatrixXd common = one.common - base::product(own, base::transposed_product(own, one.common));
    const Eigen::VectorXd x = one.x - base::product(own, base::transposed_product(own, one.x));
    const Eigen::MatrixXd a = base::transposed_product(common, common);
    const Eigen::VectorXd b = base::transposed_product(common, x);
    const std::array<Eigen::Index, 4> at{0, 1, 2 + static_cast<Eigen::Index>(motion.group), count - 1};
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      right[at[static_cast<std::size_t>(i)]] += b[i];
      for (Eigen::Index j = 0; j < a.cols(); ++j) {
        normal(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(j)]) += a(i, j);
      }
    }
  }
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  solved.minimum = resisting(scaled, scale.cwiseProduct(right), only_falls(set));
  solved.minimum.at.array() *= scale.array();
  return solved;
}

/// Values of the parameters in the layout without effects.
FitPoint point_of(const TrackSet& set, const Solved& solved) {
  const Eigen::VectorXd& found = solved.minimum.at;
  FitPoint start;
  start.global = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(ParameterLayout(set, {}).globals().size()));
  start.global.head(2) = found.head(2);
  for (Eigen::Index g = 0; g < std::ssize(set.groups); ++g) {
    start.global[2 + g] = std::asin(std::clamp(found[2 + g], -0.99, 0.99));
  }
  for (std::size_t i = 0; i < solved.motions.size(); ++i) {
    const Integrated& one = solved.motions[i];
    Eigen::VectorXd of(one.common.cols());
    of.head(3) << found[0], found[1], found[2 + static_cast<Eigen::Index>(set.motions[i].group)];
    if (of.size() > 3) of[3] = found[found.size() - 1];
    const Eigen::VectorXd left = one.x - base::product(one.common, of);
    Eigen::VectorXd own = base::least_squares(one.own, left);
    // The integral runs from the first position, not from x0.
    own[1] += found[0] / set.masses[set.motions[i].mass].mass_kg * (set.motions[i].x_m.front() - own[0]);
    start.own.push_back(own);
  }
  return start;
}

}  // namespace

FitPoint integrated_start(const TrackSet& set) {
  return point_of(set, solve(set, {}));
}

bool has_integrated_start(std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  return info.law.force_n != nullptr && info.law.passing && info.law.size == 0 && info.parameters.size() == 2 &&
         info.parameters[1].reach == Reach::places;
}

std::optional<FitPoint> integrated_start(const TrackSet& set, std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  if (!has_integrated_start(effect)) return {};
  const ParameterRange range = range_of_places(set);
  const std::vector<double> places = info.shapes({range.low, range.high, set.groups.size() > 1, set.held_m_s});
  if (places.size() < 2) return {};
  const auto value_at = [&](double place_m) {
    const Minimum minimum = solve(set, PlacedForce{effect, place_m}).minimum;
    return minimum.at[minimum.at.size() - 1] > 0.0 ? minimum.value : 0.0;
  };
  double best_m = places.front(), least = 0.0;
  for (const double place : places) {
    const double value = value_at(place);
    if (!(value < least)) continue;
    least = value;
    best_m = place;
  }
  if (!(least < 0.0)) return {};
  constexpr int kBits = 12;
  const double apart_m = places[1] - places[0];
  const auto [place_m, value] = boost::math::tools::brent_find_minima(value_at, std::max(range.low, best_m - apart_m),
                                                                      std::min(range.high, best_m + apart_m), kBits);
  if (value < least) best_m = place_m;
  const Solved solved = solve(set, PlacedForce{effect, best_m});
  FitPoint start = point_of(set, solved);
  const Eigen::Index before = start.global.size();
  start.global.conservativeResize(before + 2);
  start.global[before] =
      std::clamp(solved.minimum.at[solved.minimum.at.size() - 1], info.parameters[0].step, 0.9 * most_of(set, effect));
  start.global[before + 1] = best_m;
  return start;
}

}  // namespace glidelab::diagnose
