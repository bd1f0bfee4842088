#include "diagnose/tracks/rounded_positions.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math/dense.h"

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

void add_rounding(TrackedMotion& motion) {
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
