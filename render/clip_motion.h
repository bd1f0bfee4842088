/// Where the glider is during each frame's exposure.
///
/// The exposure of frame k is [k / rate, k / rate + exposure] on the clock of sim (the motion starts at t = 0, with the
/// first exposure); its middle has the time k / rate on the clock of the recording.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "render/scenario.h"
#include "sim/simulate.h"

namespace glidelab::render {

/// Frames whose exposure ends within the motion's duration; at least one.
std::size_t frame_count(const Recording& recording, const sim::MotionSetup& motion);

struct FrameMotion {
  std::size_t frame = 0;
  sim::State middle;        ///< at mid-exposure; t_s = frame / rate, the recording's clock
  std::vector<double> x_m;  ///< at the middles of equal parts of the exposure, in order
};

/// Calls `visit` for every frame in order, simulating in chunks so that no clip is held in memory. The exposure is cut
/// into parts in which the marker moves at most `longest_step_m` (one part where it stays below that).
void for_each_frame(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording,
                    double longest_step_m, const std::function<void(const FrameMotion&)>& visit);

}  // namespace glidelab::render
