/// The noise of the measured positions, from the data alone: no law of motion is assumed.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {

/// A first estimate of the standard deviation of one position, from how far each lies off the cubic through its four
/// nearest neighbours (for uniform times the fourth difference over sqrt(70)). The smaller half of the squares counts,
/// so that outliers and impacts do not. Never below q / sqrt(12), where all positions are whole multiples of a step q
/// (a rounded file): between two multiples a rounded position says nothing.
double pilot_noise(std::span<const double> t_s, std::span<const double> x_m);

/// The step q where all positions are whole multiples of it from the first one on (a rounded file), 0 otherwise.
double rounding_step(std::span<const double> x_m);

/// Noise as a stationary process: white, or white plus a part that is correlated as c rho^|lag| (a codec's, or that of
/// rounding a slow motion).
struct PositionNoise {
  double sd_m = 0.0;
  std::vector<double> autocovariance;  ///< at lags of 0, 1, … points; a single number where the noise is white
};

/// The sum of the autocovariance over all lags, of both signs: the variance of the white noise that would act alike on
/// everything wider than the correlation.
double sum_over_lags(const std::vector<double>& autocovariance);

/// Bandwidths from an end of the points at which a kernel is complete: the variance of a is within 20 % of inside.
inline constexpr double kCompleteKernel = 3.0;

/// One part of the motion with its smoother, over the same times.
struct NoisePiece {
  const LocalCubic* cubic;
  std::span<const double> x_m;
};

/// From the residuals r = x - Sx of points whose kernel is complete. Smoothing follows part of the noise: with p = 1 -
/// s the filter that leaves r, E[r_j r_(j+k)] = sum_l gamma_l P(k-l), P the autocorrelation of p. White noise is
/// assumed unless the residuals' correlation contradicts it (chi^2 at 1e-3); then sigma_w^2, c >= 0 and rho follow by
/// least squares. The bandwidth should be that of the lines for which the noise is needed: what is slower than the
/// kernel counts as motion. `at_least_m`, as from pilot_noise(), is used where there are fewer than 20 such residuals.
PositionNoise estimate_noise(const std::vector<NoisePiece>& pieces, double at_least_m);

}  // namespace glidelab::core
