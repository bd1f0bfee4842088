#include "validate/oracle_bandwidth.h"

#include <algorithm>
#include <cmath>

#include "core/local_cubic.h"
#include "core/quantile.h"

namespace glidelab::validate {

std::optional<double> true_error(const std::vector<TrueStretch>& stretches, const std::vector<double>& autocovariance,
                                 double bandwidth_s) {
  core::RowVariance variance(autocovariance);
  double sum = 0.0;
  std::size_t points = 0;
  for (const TrueStretch& stretch : stretches) {
    if (stretch.t_s.size() < 2) continue;
    const core::LocalCubic cubic(stretch.t_s, bandwidth_s);
    const double margin = 0.1 * (stretch.t_s.back() - stretch.t_s.front());
    for (std::size_t j = 0; j < stretch.t_s.size(); ++j) {
      if (stretch.t_s[j] < stretch.t_s.front() + margin || stretch.t_s[j] > stretch.t_s.back() - margin) continue;
      const auto row = cubic.row_of_point(j);
      if (!row) return {};
      const double bias = core::weighted_sums(*row, stretch.x_m).a_m_s2 - stretch.a_m_s2[j];
      sum += bias * bias + variance.of_a(*row);
      ++points;
    }
  }
  if (points == 0) return {};
  return sum / static_cast<double>(points);
}

std::optional<OracleBandwidth> best_bandwidth(const std::vector<TrueStretch>& stretches,
                                              const std::vector<double>& autocovariance) {
  double longest = 0.0, step = 0.0;
  for (const TrueStretch& stretch : stretches) {
    if (stretch.t_s.size() < 2) continue;
    longest = std::max(longest, stretch.t_s.back() - stretch.t_s.front());
    step = std::max(step, core::median_step(stretch.t_s));
  }
  std::optional<OracleBandwidth> best;
  const auto search = [&](double from, double to, double ratio) {
    for (double h = from; h > 0.0 && h <= to; h *= ratio) {
      const auto error = true_error(stretches, autocovariance, h);
      if (error && (!best || *error < best->mean_square_m2_s4)) best = OracleBandwidth{h, *error};
    }
  };
  search(1.2 * step, 0.2 * longest, 1.1);
  for (const double ratio : {1.01, 1.001}) {
    if (!best) break;
    const double reach = ratio == 1.01 ? 1.1 : 1.01, centre = best->bandwidth_s;
    search(std::max(1.2 * step, centre / reach), std::min(0.2 * longest, centre * reach), ratio);
  }
  return best;
}

}  // namespace glidelab::validate
