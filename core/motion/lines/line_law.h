/// The law of one line: the motion under it, and the bias of smoothing and least squares under it.
///
/// A line a = a0 - k v is the law dv/dt = a0 - k v, whose motion in each stretch of one direction is known in closed
/// form except for x_0, v_0:
///
///     x = x_0 + v_0 phi(t) + a0 psi(t),
///     phi = (1 - exp(-k t)) / k,     psi = (t - phi) / k,     phi' = 1 - k phi,     psi' = phi,
///
/// for any k and t, of either sign; phi and psi become t and t^2/2 at k = 0.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "core/motion/lines/line_fit.h"

namespace glidelab::core {

struct LawFunctions {
  double phi = 0.0;
  double psi = 0.0;
};

inline LawFunctions law_functions(double k_1_s, double t_s) {
  constexpr double kSeries = 1e-3;  // |k t| below which three terms of the series are exact to 1e-11
  const double s = k_1_s * t_s;
  if (std::abs(s) < kSeries) {
    return {t_s * (1.0 - s / 2.0 + s * s / 6.0), t_s * t_s * (0.5 - s / 6.0 + s * s / 24.0)};
  }
  const double phi = -std::expm1(-s) / k_1_s;
  return {phi, (t_s - phi) / k_1_s};
}

/// The bias that smoothing and ordinary least squares give a line under its own law, so that it can be subtracted, for
/// the line that fit_line() gave for this input.
///
/// v_0 of the law's motion is taken from the stretch's smoothed v by least squares. That motion without noise, at the
/// same times, through the same kernels and the same least squares, gives a line (k', a0'); and so
///
///     bias(k, a0) = (k' - k, a0' - a0) + bias of noise in v,      (k, a0) = line - bias(k, a0)  by fixed point.
///
/// (A kernel leaves noise in v, which pulls the slope towards zero: -(A'A)^-1 (sum of k var v_j + cov(v_j, a_j), 0).)
/// The random covariance of the corrected line is G C G', G = (1 + d bias / d(k, a0))^-1.
///
/// It holds where the law does: the smoothed points must lie about the law's own smoothed points no further than the
/// noise explains (chi2_ratio_limit), and the bias of k must be less than half of k, or of two of its standard
/// deviations. Otherwise, and with a known force (v then obeys no such law), there is nothing to subtract, and the
/// result is empty.
std::optional<LawBias> law_bias(const LineInput& input, const LineFit& line, const std::vector<double>& autocovariance);

/// The line with its bias subtracted (unchanged if there is none to subtract); its uncertainty includes that of the
/// subtraction.
LineFit without_law_bias(LineFit line);

}  // namespace glidelab::core
