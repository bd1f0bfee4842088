/// The motion x = x_0 + v_0 phi(t) + a0 psi(t) under the law of one line, dv/dt = a0 - k v:
///
///     phi = (1 - exp(-k t)) / k,     psi = (t - phi) / k,     phi' = 1 - k phi,     psi' = phi,
///
/// for any k and t, of either sign; they go over into t and t^2/2 at k = 0.
#pragma once

#include <cmath>

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

}  // namespace glidelab::core
