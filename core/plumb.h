/// The plumb line in a picture, and the inclination of the line of motion against it.
///
/// A thread is a thin dark or bright line in the region given. Row by row (column by column where it runs more along
/// the picture's rows) its places are found as what stands out from both sides; the straight line (after the lens's
/// distortion is undone) that most of them lie on is the thread. It is then fitted as a whole
/// (core/thread_fit.h). A plumb line is parallel to the plane of motion, so that its direction, restituted to
/// that plane, does not depend on how far before or behind the plane it hangs.
#pragma once

#include <opencv2/core.hpp>

#include <functional>
#include <optional>
#include <vector>

#include "core/experiment.h"
#include "core/mode_axis.h"
#include "core/motion_axis.h"
#include "core/restitution.h"
#include "core/results.h"

namespace glidelab::core {

/// The thread's middle in each row (or column) in which it is seen, and the same with the thread turned by one standard
/// deviation of its direction; pixels. Empty where there is no thread.
struct ThreadInPicture {
  std::vector<cv::Point2d> points;
  std::vector<cv::Point2d> turned;
  std::size_t rows = 0;  ///< that the fit rests on
};

/// `straight` undoes the lens.
ThreadInPicture find_thread(const cv::Mat& grey, cv::Rect region,
                            const std::function<std::optional<cv::Point2d>(cv::Point2d)>& straight);

/// alpha = asin(axis . down), positive downhill, down being the thread's direction towards the picture's lower edge.
/// Its standard deviation joins the thread's, the axis's and what the modes, each an error of one standard deviation of
/// camera or plane, make of the angle between them. InputError where the region leaves the picture or holds no
/// thread; undetermined where the marker does not move.
Quantity plumb_angle(const PlumbSetup& setup, const Restitution& restitution, const MotionAxis& axis,
                     std::optional<cv::Size> picture_size, const std::vector<ModeAxis>& modes = {});

}  // namespace glidelab::core
