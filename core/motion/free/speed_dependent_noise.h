/// Noise of the positions that grows with the speed: a marker that is smeared over pixels, times that jitter.
///
///     s^2(v) = a + b v^2,
///
/// from the squared residuals of the smoothing (points whose kernel is complete) by least squares, each weighted with
/// the inverse of its variance 2 s^4, in a few passes; b is then shrunk by sd_b^2 / b (the positive part of James and
/// Stein's rule), with the mean variance kept. A threshold in its place, the growth taken as it is where it is
/// significant and not at all elsewhere, leaves intervals too narrow wherever a growth that matters is not significant.
/// It matters for lines: their ends at high speed weigh most.
#pragma once

#include <vector>

#include "core/motion/smoothing/noise.h"

namespace glidelab::core {

/// s(v) at every point of every piece over the root mean square of the residuals. Empty where b is not above its own
/// standard deviation, or there are fewer than 40 residuals: the noise is then taken as one.
std::vector<std::vector<double>> speed_factors(const std::vector<NoisePiece>& pieces);

}  // namespace glidelab::core
