/// The plumb line in a picture, and the inclination of the line of motion against it.
///
/// A plumb line (found by core/thread_search.h) is parallel to the plane of motion, so that its direction, restituted
/// to that plane, does not depend on how far before or behind the plane it hangs.
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/camera/mode_axis.h"
#include "core/pictures/camera/motion_axis.h"
#include "core/pictures/camera/restitution.h"
#include "core/result/results.h"

namespace glidelab::core {

/// alpha = asin(axis . down), positive downhill, down being the thread's direction towards the picture's lower edge.
/// Its standard deviation joins the thread's, the axis's and what the modes, each an error of one standard deviation of
/// camera or plane, make of the angle between them. InputError where the region leaves the picture or holds no
/// thread; undetermined where the marker does not move.
Quantity plumb_angle(const PlumbSetup& setup, const Restitution& restitution, const MotionAxis& axis,
                     std::optional<cv::Size> picture_size, const std::vector<ModeAxis>& modes = {});

}  // namespace glidelab::core
