/// The bandwidth that is best for a = x'' where the truth is known: what a rule (core/bandwidth_rule.h) is measured by.
///
///     h* = least of the mean over the points of  bias(t; h)^2 + variance(t; h)
///
/// with the bias from smoothing the true positions and the variance from the weights and the true noise, both exact;
/// no noise is drawn. Points nearer to an end than a tenth of the stretch do not count, as in the rules.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace glidelab::validate {

struct TrueStretch {
  std::span<const double> t_s;
  std::span<const double> x_m;
  std::span<const double> a_m_s2;
};

/// Mean square error of a at one bandwidth; nothing where a kernel holds too few points.
std::optional<double> true_error(const std::vector<TrueStretch>& stretches, const std::vector<double>& autocovariance,
                                 double bandwidth_s);

struct OracleBandwidth {
  double bandwidth_s = 0.0;
  double mean_square_m2_s4 = 0.0;
};

/// Searched from 1.2 median time steps to a fifth of the longest stretch, to a part in 1000.
std::optional<OracleBandwidth> best_bandwidth(const std::vector<TrueStretch>& stretches,
                                              const std::vector<double>& autocovariance);

}  // namespace glidelab::validate
