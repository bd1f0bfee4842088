/// The noise of a motion's positions from its free stretches, and its growth with speed.
#pragma once

#include <optional>
#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/smoothing/noise.h"

namespace glidelab::core {

/// Noise of the positions that grows with speed: a marker smeared over pixels, times that jitter.
///
///     s^2(v) = a + b v^2,
///
/// from the squared residuals of the smoothing (points whose kernel is complete) by least squares, each weighted with
/// the inverse of its variance 2 s^4, in a few passes; b is then shrunk by sd_b^2 / b (the positive part of James and
/// Stein's rule), with the mean variance kept. A threshold instead (the measured growth if it is significant, otherwise
/// none) leaves intervals too narrow whenever a growth that matters is not significant. Such growth matters for lines:
/// their ends at high speed weigh most.
///
/// s(v) at every point of every piece, over the rms of the residuals. Empty if b is not above its own standard
/// deviation, or there are fewer than 40 residuals: the noise is then taken as constant.
std::vector<std::vector<double>> speed_factors(const std::vector<NoisePiece>& pieces);

/// The noise of a motion's positions, from its free stretches smoothed with one bandwidth.
PositionNoise noise_at(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s);

/// The noise's factor at every point of the motion (speed_factors(); 1 outside of the stretches), or empty if it is 1
/// everywhere.
std::vector<double> noise_factors(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s);

/// The step of a recording's rounding, if rounding is most of its noise and the motion is so slow that one position in
/// five repeats the previous one: the rounding's error then lasts over frames, and no noise model here describes it.
std::optional<double> coarse_rounding(const Motion& motion, const PositionNoise& noise);

}  // namespace glidelab::core
