/// Asymptotic constants of the local cubic (order 3), from which bandwidth rules follow.
///
/// For uniform times of step dt, white noise of variance s^2 and h of several steps, far from an end, the estimate of
/// the d-th derivative by the equivalent kernel K_d (Fan and Gijbels 1996, section 3.2.2) has
///
///     bias = B_d h^(4-d) x''''    variance = R_d s^2 dt / h^(2d+1)    (d = 0 and 2, where 3 - d is odd)
///
/// so the mean square error is least at  h^9 = (2d+1) R_d / (2 (4-d) B_d^2) · s^2 dt / x''''^2.
///
///     Gaussian, K = exp(-u^2/2)/sqrt(2 pi):   K_0 = (3 - u^2)/2 K      B_0 = -1/8   R_0 = 27/(32 sqrt(pi))
///                                             K_2 = (u^2 - 1) K        B_2 =  1/2   R_2 = 3/(8 sqrt(pi))
///     bimodal, K = 2 u^2 exp(-u^2)/sqrt(pi):  K_0 = (5/2 - u^2) K      B_0 = -5/32  R_0 = 105/(64 sqrt(2 pi))
///
/// For a (d = 2) that is h^9 = 5 R_2 s^2 dt / x''''^2 = 1.058 s^2 dt / x''''^2.
#pragma once

#include <cmath>
#include <numbers>

namespace glidelab::core {

struct KernelConstants {
  int derivative = 0;
  double bias = 0.0;      ///< B_d
  double variance = 0.0;  ///< R_d

  /// h^9 x''''^2 / (s^2 dt) at the least mean square error.
  double best_h9() const { return (2 * derivative + 1) * variance / (2.0 * (4 - derivative) * bias * bias); }
};

inline constexpr KernelConstants kGaussianX{0, -0.125, 27.0 / 32.0 * std::numbers::inv_sqrtpi};
inline constexpr KernelConstants kGaussianA{2, 0.5, 3.0 / 8.0 * std::numbers::inv_sqrtpi};
inline constexpr KernelConstants kBimodalX{0, -5.0 / 32.0,
                                           105.0 / 64.0 * std::numbers::inv_sqrtpi / std::numbers::sqrt2};

/// The bandwidth that serves `wanted` where h serves `given`: the same x'''' and noise.
inline double convert_bandwidth(double h, const KernelConstants& given, const KernelConstants& wanted) {
  return h * std::pow(wanted.best_h9() / given.best_h9(), 1.0 / 9.0);
}

/// Least of the residual squares criterion s^2 (1 + 4 V) + bias part (Fan and Gijbels 1995): its h^9 x''''^2/(s^2 dt).
/// The residuals' bias part is C (x''''/4!)^2 h^8 with C = 4! = the norm of the Hermite polynomial He_4; so
/// 8 C (x''''/24)^2 h^7 = 4 R_0 s^2 dt / h^2.
inline constexpr double kResidualSquaresH9 = 4.0 * kGaussianX.variance * 24.0 * 24.0 / (8.0 * 24.0);

}  // namespace glidelab::core
