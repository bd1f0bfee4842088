/// What is found about the light of a recording: edges of shadows, gradients, lamps that flicker.
///
/// Each is reported only where it may displace the marker by more than a tenth of the noise of a position. A step of
/// the light by h across the middle of a disc of radius r displaces the centroid of its light by 2 h r / (3 pi), at
/// most; a gradient and a flicker by what path_light.h and lamp_flicker.h say. The analysis fits an outline, which
/// such light displaces less.
#pragma once

#include <vector>

#include "core/check/check_result.h"
#include "core/experiment/experiment.h"

namespace glidelab::core {

/// Notes: for each view of the track its edges and its gradient; for all clips of the camera its flicker.
std::vector<Finding> light_findings(const Experiment& experiment, const std::vector<ClipCheck>& clips);

}  // namespace glidelab::core
