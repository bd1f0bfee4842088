/// Quantiles and tails of the usual distributions (Boost.Math, whose templates are compiled here once). Degrees of
/// freedom are above 0 and, unless it says otherwise, finite; probabilities lie in (0, 1).
#pragma once

namespace glidelab::base {

double normal_cdf(double z);
double normal_tail(double z);  ///< P(> z)
double normal_quantile(double p);
double normal_upper_quantile(double p);  ///< exceeded with probability p

/// Infinite degrees of freedom: the normal distribution.
double student_t_tail(double degrees, double t);  ///< P(> t)
double student_t_quantile(double degrees, double p);

double chi2_quantile(double degrees, double p);
double chi2_upper_quantile(double degrees, double p);  ///< exceeded with probability p

double beta_quantile(double a, double b, double p);

/// Half the width of the normal distribution's 95 % interval, in standard deviations: the 0.975 quantile.
///
/// A constant, unlike normal_quantile(0.975).
inline constexpr double kNormal95 = 1.959963984540054;

}  // namespace glidelab::base
