/// The noise of a motion's positions, from its free stretches smoothed with one bandwidth.
#pragma once

#include <optional>
#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/smoothing/noise.h"

namespace glidelab::core {

PositionNoise noise_at(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s);

/// The noise's factor at every point of the motion (speed_dependent_noise.h; 1 outside of the stretches), or nothing
/// where it is one everywhere.
std::vector<double> noise_factors(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s);

/// The step of a recording's rounding where that is most of its noise and the motion is so slow that one position in
/// five repeats the one before: the rounding's error then lasts over frames, and no noise model here describes it.
std::optional<double> coarse_rounding(const Motion& motion, const PositionNoise& noise);

}  // namespace glidelab::core
