#include "core/motion/free/pilot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/quantile.h"
#include "core/motion/smoothing/local_cubic.h"

namespace glidelab::core {
namespace {

constexpr double kNoiseShare = 0.10;      // of the median |a| that its noise may be
constexpr double kLongestPart = 12.0;     // of the moving time that the bandwidth may be
constexpr double kGrowth = 1.15;          // from one bandwidth to the next
constexpr double kStillDeviations = 5.0;  // of v: one point in 1e6 by chance

/// Robust standard deviation of x about the smoothed x; more than the pilot noise where the noise is correlated.
double residual_noise(const Motion& motion, const std::vector<std::optional<SmoothedPoint>>& smoothed,
                      double weight_of_own_point) {
  std::vector<double> off;
  for (std::size_t j = 0; j < smoothed.size(); ++j) {
    if (smoothed[j]) off.push_back(std::abs(motion.y_m[j] - smoothed[j]->x_m));
  }
  // var(r) = s^2 (1 - own weight) for white noise: sum of squared weights is the own weight for a projection, and
  // nearly so here.
  return kSdOverMedian * quantile(off, 0.5) / std::sqrt(std::max(0.1, 1.0 - weight_of_own_point));
}

Pilot smooth_at(const Motion& motion, double bandwidth_s) {
  const LocalCubic cubic(motion.t_s, bandwidth_s);
  const std::size_t n = motion.t_s.size();
  const auto of_y = cubic.smooth(motion.y_m);
  const auto of_x = motion.forced ? cubic.smooth(motion.x_m) : of_y;
  const double own = std::min(0.9, 0.6 * motion.step_s / bandwidth_s);  // 3 / (2 sqrt(2 pi)) dt / h
  const double noise = std::max(motion.noise_m, residual_noise(motion, of_y, own));
  Pilot pilot;
  pilot.bandwidth_s = bandwidth_s;
  pilot.x_m = motion.x_m;
  pilot.v_m_s.assign(n, 0.0);
  pilot.a_m_s2.assign(n, 0.0);
  pilot.sd_v_m_s.assign(n, std::numeric_limits<double>::infinity());
  pilot.sd_a_m_s2 = pilot.sd_v_m_s;
  RowVariance variance({noise * noise});
  std::vector<double> speeds;
  for (std::size_t j = 0; j < n; ++j) {
    if (!of_y[j]) continue;
    const auto row = cubic.row_of_point(j);
    pilot.x_m[j] = of_x[j]->x_m;
    pilot.v_m_s[j] = of_x[j]->v_m_s;
    pilot.a_m_s2[j] = of_y[j]->a_m_s2;
    pilot.sd_v_m_s[j] = std::sqrt(variance.of_v(*row));
    pilot.sd_a_m_s2[j] = std::sqrt(variance.of_a(*row));
    speeds.push_back(std::abs(pilot.v_m_s[j]));
  }
  pilot.top_speed_m_s = quantile(speeds, 0.95);
  return pilot;
}

}  // namespace

double still_below(const Pilot& pilot, std::size_t point) {
  return std::max(kStillDeviations * pilot.sd_v_m_s[point], kStillShare * pilot.top_speed_m_s);
}

Pilot first_smoothing(const Motion& motion) {
  double bandwidth = 2.0 * motion.step_s;
  for (;;) {
    Pilot pilot = smooth_at(motion, bandwidth);
    std::vector<double> magnitude, noise;
    for (std::size_t j = 0; j < motion.t_s.size(); ++j) {
      if (std::abs(pilot.v_m_s[j]) <= still_below(pilot, j)) continue;
      magnitude.push_back(std::abs(pilot.a_m_s2[j]));
      noise.push_back(pilot.sd_a_m_s2[j]);
    }
    const double moving_s = motion.step_s * static_cast<double>(std::max(magnitude.size(), motion.t_s.size() / 4));
    const bool quiet = !magnitude.empty() && quantile(noise, 0.5) <= kNoiseShare * quantile(magnitude, 0.5);
    if (quiet || kGrowth * bandwidth > moving_s / kLongestPart) return pilot;
    bandwidth *= kGrowth;
  }
}

}  // namespace glidelab::core
