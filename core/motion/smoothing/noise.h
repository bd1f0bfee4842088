/// The noise of the measured positions, from the data alone: no law of motion is assumed.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {

/// A first estimate of the standard deviation of one position, from its deviation from the cubic through its four
/// nearest neighbours (for uniform times the fourth difference over sqrt(70)). Only the smaller half of the squares
/// counts, so that outliers and impacts do not. If all positions are whole multiples of a step q (a rounded file), the
/// estimate is never below q / sqrt(12): between two multiples a rounded position carries no information. The same
/// holds for coarsest_step().
double pilot_noise(std::span<const double> t_s, std::span<const double> x_m);

/// The step q if all positions differ from the first by whole multiples of it (a rounded file, or counts times a length
/// that were written with few decimals), 0 otherwise.
double rounding_step(std::span<const double> x_m);

/// The step with which each position is written, if it grows with the size of the number: a fixed number of digits, as
/// in Tracker's default format (9.927E-2, then 0.102), makes the last decimal ten times as coarse in each decade. Empty
/// if all decades have the same last decimal. The last decimal of a decade is that of its numbers; fewer than six
/// different ones do not show it, and take that of the smaller numbers.
std::vector<double> written_steps(std::span<const double> x_m);

/// The coarsest of the written_steps() that one in ten positions or more have, or a coarser one; 0 if there are none.
double coarsest_step(std::span<const double> x_m);

/// Noise as a stationary process: white, or white plus a part that is correlated as c rho^|lag| (a codec's, or that of
/// rounding a slow motion).
struct PositionNoise {
  double sd_m = 0.0;
  std::vector<double> autocovariance;  ///< at lags of 0, 1, … points; a single number if the noise is white
};

/// The sum of the autocovariance over all lags, of both signs: the variance of the white noise that would have the same
/// effect on everything wider than the correlation.
double sum_over_lags(const std::vector<double>& autocovariance);

/// Distance from an end of the points, in bandwidths, at which a kernel is complete: the variance of a is within 20 %
/// of inside.
inline constexpr double kCompleteKernel = 3.0;

/// One part of the motion with its smoother, over the same times.
struct NoisePiece {
  const LocalCubic* cubic;
  std::span<const double> x_m;
};

/// The noise is estimated from the residuals r = x - Sx of points whose kernel is complete. Smoothing follows part of
/// the noise: with p = 1 - s the filter that leaves r, E[r_j r_(j+k)] = sum_l gamma_l P(k-l), P the autocorrelation of
/// p. White noise is assumed unless the residuals' correlation contradicts it (chi^2 at 1e-3); then sigma_w^2, c >= 0
/// and rho follow by least squares. The bandwidth should be that of the lines for which the noise is needed: anything
/// slower than the kernel counts as motion. `at_least_m`, e.g. from pilot_noise(), is used if there are fewer than 20
/// such residuals.
PositionNoise estimate_noise(const std::vector<NoisePiece>& pieces, double at_least_m);

}  // namespace glidelab::core
