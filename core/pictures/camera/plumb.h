/// The plumb line in an image, and the inclination of the line of motion against it.
///
/// A plumb line (found by thread_search.h) is parallel to the plane of motion, so that its direction, restituted to
/// that plane, does not depend on how far in front of or behind the plane it hangs.
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

/// alpha = asin(axis . down), positive downhill, down being the thread's direction towards the image's lower edge.
/// Its standard deviation combines those of the thread and the axis with the effect of the modes (each an error of one
/// standard deviation of camera or plane) on the angle between them. InputError if the region leaves the image or holds
/// no thread; undetermined if the marker does not move.
Quantity plumb_angle(const PlumbSetup& setup, const Restitution& restitution, const MotionAxis& axis,
                     std::optional<cv::Size> image_size, const std::vector<ModeAxis>& modes = {});

}  // namespace glidelab::core
