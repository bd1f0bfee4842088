/// From smoothed points to what a line is fitted to.
#pragma once

#include <vector>

#include "core/motion/free/motion.h"
#include "core/motion/lines/line_fit.h"
#include "core/motion/lines/stretch_points.h"

namespace glidelab::core {

/// The used points of one direction; `bias` is that of smoothing_bias() for the same points. With a known force a is
/// y'', and one standard deviation of the mass changes it by F sd / m^2.
LineInput line_input(const Motion& motion, const std::vector<StretchPoint>& points, const std::vector<double>& bias,
                     int direction, double mass_kg, double mass_sd_kg);

/// What displacements of the track's positions (TrackData::shared_m) do to v and a of the input's points.
std::vector<std::vector<MotionShift>> calibration_shifts(const Motion& motion, const LineInput& input,
                                                         const std::vector<std::vector<double>>& shared_m);

}  // namespace glidelab::core
