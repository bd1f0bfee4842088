#include "diagnose/tracks/rounded_positions.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "base/math/dense.h"
#include "core/motion/smoothing/noise.h"
#include "diagnose/tracks/neighbour_residual.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kHalfWindow = 7;   // frames either side: a slope is then known to 0.02 steps a frame
constexpr double kAlikeTooth = 0.2;      // of a step: errors within this distance correlate
constexpr double kMostlyRounding = 0.5;  // of a step: noise below that has less than three times the variance of
                                         // rounding

/// Steps a second at each time, by a parabola through the positions around it.
std::vector<double> speeds_of(const std::vector<double>& t_s, const std::vector<double>& x_m, double step_m) {
  std::vector<double> speeds;
  for (std::size_t p = 0; p < t_s.size(); ++p) {
    const std::size_t from = p - std::min(p, kHalfWindow), to = std::min(p + kHalfWindow + 1, t_s.size());
    Eigen::MatrixXd design(static_cast<Eigen::Index>(to - from), 3);
    Eigen::VectorXd x(design.rows());
    for (std::size_t q = from; q < to; ++q) {
      const double t = t_s[q] - t_s[p];
      const auto row = static_cast<Eigen::Index>(q - from);
      design.row(row) << 1.0, t, t * t;
      x[row] = (x_m[q] - x_m[p]) / step_m;
    }
    speeds.push_back(base::least_squares(design, x)(1, 0));
  }
  return speeds;
}

}  // namespace

std::vector<double> frames_alike(const std::vector<double>& t_s, const std::vector<double>& x_m, double step_m) {
  const std::vector<double> speed = speeds_of(t_s, x_m, step_m);
  // Steps between a frame and the next one.
  std::vector<double> on;
  for (std::size_t p = 0; p + 1 < t_s.size(); ++p)
    on.push_back(0.5 * (speed[p] + speed[p + 1]) * (t_s[p + 1] - t_s[p]));
  std::vector<double> alike;
  for (std::size_t p = 0; p < t_s.size(); ++p) {
    const double own = p + 1 < t_s.size() ? (p > 0 ? 0.5 * (on[p - 1] + on[p]) : on[p]) : on[p - 1];
    const double whole = std::round(own);
    double many = 1.0, shift = 0.0;
    for (std::size_t q = p; q + 1 < t_s.size(); ++q) {
      shift += on[q] - whole;
      if (std::abs(shift) > kAlikeTooth) break;
      many += 1.0;
    }
    shift = 0.0;
    for (std::size_t q = p; q > 0; --q) {
      shift += on[q - 1] - whole;
      if (std::abs(shift) > kAlikeTooth) break;
      many += 1.0;
    }
    alike.push_back(many);
  }
  return alike;
}

namespace {

constexpr std::size_t kFewestFine = 12;  // residuals that show the noise without the coarse part
constexpr double kMatters = 0.3;         // of the noise: less adds under a tenth to its variance

/// A residual from the neighbours, normalised, and what rounding adds to its variance.
struct RoundedResidual {
  double off_m = 0.0, rounding_m2 = 0.0;
};

std::vector<RoundedResidual> rounded_residuals(const TrackedMotion& motion, const std::vector<double>& steps_m) {
  // Squares of the weights of the position and of its neighbours at even times: (-1, 4, 6, 4, -1)² / 70.
  constexpr std::array<double, 5> kShares = {1.0 / 70.0, 16.0 / 70.0, 36.0 / 70.0, 16.0 / 70.0, 1.0 / 70.0};
  std::vector<RoundedResidual> residuals;
  for (std::size_t i = 2; i + 2 < motion.t_s.size(); ++i) {
    RoundedResidual one{neighbour_residual(motion.t_s, motion.x_m, i), 0.0};
    bool any_out = false;
    for (std::size_t k = 0; k < kShares.size(); ++k) {
      any_out = any_out || motion.outlier[i + k - 2] != 0;
      one.rounding_m2 += kShares[k] * std::pow(steps_m[i + k - 2], 2) / 12.0;
    }
    if (!any_out) residuals.push_back(one);
  }
  return residuals;
}

/// The standard deviation of the noise besides rounding: the likeliest, of some from a thousandth of the coarsest
/// rounding to ten times it; no residual counts for more than four standard deviations.
double besides_rounding(const std::vector<RoundedResidual>& residuals, double coarsest_m) {
  constexpr double kMostSquare = 16.0, kRatio = 1.05;
  double best_m = 0.0, least = std::numeric_limits<double>::infinity();
  for (double s = 1e-3 * coarsest_m; s < 10.0 * coarsest_m; s *= kRatio) {
    double cost = 0.0;
    for (const RoundedResidual& one : residuals) {
      const double variance = s * s + one.rounding_m2;
      cost += std::log(variance) + std::min(one.off_m * one.off_m / variance, kMostSquare);
    }
    if (cost >= least) continue;
    least = cost;
    best_m = s;
  }
  return best_m;
}

/// Gives each position the noise of its own step; false if the steps do not matter, if a tenth of the positions or more
/// have a coarse one, or if too few show the noise without it: the motion then counts as rounded to the coarse step.
bool add_own_rounding(TrackedMotion& motion) {
  const std::vector<double> steps_m = core::written_steps(motion.x_m);
  if (steps_m.empty() || motion.t_s.size() < 5) return false;
  const auto [fine, coarse] = std::minmax_element(steps_m.begin(), steps_m.end());
  const double coarsest_m = *coarse / std::sqrt(12.0);
  if (coarsest_m < kMatters * motion.sd_m) return false;
  if (const double of_many_m = core::coarsest_step(motion.x_m); of_many_m / std::sqrt(12.0) >= kMatters * motion.sd_m) {
    motion.step_m = of_many_m;
    return false;
  }
  const std::vector<RoundedResidual> residuals = rounded_residuals(motion, steps_m);
  const auto fines = std::count_if(residuals.begin(), residuals.end(), [&](const RoundedResidual& one) {
    return one.rounding_m2 < 0.1 * coarsest_m * coarsest_m;
  });
  if (static_cast<std::size_t>(fines) < kFewestFine) {
    motion.step_m = *coarse;
    return false;
  }
  const double besides_m = besides_rounding(residuals, coarsest_m);
  motion.step_m = 0.0;
  motion.sd_m = std::hypot(besides_m, *fine / std::sqrt(12.0));
  motion.wider.resize(steps_m.size());
  motion.coarser.resize(steps_m.size());
  for (const double step_m : std::set<double>(steps_m.begin(), steps_m.end())) {
    const double coarser = std::hypot(besides_m, step_m / std::sqrt(12.0)) / motion.sd_m;
    const double keeps = step_m > 0.0 ? std::exp(-std::pow(2.0 * std::numbers::pi * besides_m / step_m, 2)) : 0.0;
    const std::vector<double> alike =
        step_m > 0.0 ? frames_alike(motion.t_s, motion.x_m, step_m) : std::vector<double>(steps_m.size(), 1.0);
    for (std::size_t p = 0; p < steps_m.size(); ++p) {
      if (steps_m[p] != step_m) continue;
      motion.coarser[p] = coarser;
      motion.wider[p] = coarser * std::sqrt(1.0 + (alike[p] - 1.0) * keeps);
    }
  }
  return true;
}

}  // namespace

void add_rounding(TrackedMotion& motion) {
  if (add_own_rounding(motion)) return;
  if (!(motion.step_m > 0.0) || motion.t_s.size() < 3) return;
  const double rounding2 = motion.step_m * motion.step_m / 12.0;
  motion.sd_m = std::max(motion.sd_m, std::sqrt(rounding2));
  const double sensor2 = motion.sd_m * motion.sd_m - rounding2;
  const double keeps = std::exp(-std::pow(2.0 * std::numbers::pi / motion.step_m, 2) * sensor2);
  motion.wider.clear();
  for (const double many : frames_alike(motion.t_s, motion.x_m, motion.step_m)) {
    motion.wider.push_back(std::sqrt(1.0 + (many - 1.0) * keeps));
  }
}

bool noise_is_rounding(const TrackSet& set) {
  return std::any_of(set.motions.begin(), set.motions.end(), [](const TrackedMotion& motion) {
    return motion.step_m > 0.0 && motion.sd_m < kMostlyRounding * motion.step_m;
  });
}

}  // namespace glidelab::diagnose
