/// The plumb line in an image: found as a thread, and the inclination of the line of motion against it.
///
/// A plumb line is parallel to the plane of motion, so that its direction, restituted to that plane, does not depend on
/// how far in front of or behind the plane it hangs.
#pragma once

#include <opencv2/core.hpp>

#include <functional>
#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/camera/motion_axis.h"
#include "core/pictures/camera/restitution.h"
#include "core/result/results.h"

namespace glidelab::core {

/// The middle of the thread in each row (or column) in which it is seen, and the same with the thread turned by one
/// standard deviation of its direction; pixels. Empty if there is no thread.
struct ThreadInImage {
  std::vector<cv::Point2d> points;
  std::vector<cv::Point2d> turned;
  std::size_t rows = 0;  ///< used by the fit
};

/// Searches a region of an image for a thin dark or bright thread.
///
/// Row by row (column by column if it runs more along the rows) its candidate positions are those that stand out from
/// both sides; the straight line (with the lens's distortion undone) on which most of them lie is the thread. It is
/// then fitted as a whole (thread_fit.h).
///
/// `straight` undoes the lens. The region lies inside the image, which is grey of 8 or 16 bits.
ThreadInImage find_thread(const cv::Mat& grey, cv::Rect region,
                          const std::function<std::optional<cv::Point2d>(cv::Point2d)>& straight);

/// alpha = asin(axis . down), positive downhill, down being the thread's direction towards the image's lower edge.
/// Its standard deviation combines those of the thread and the axis with the effect of the modes (each an error of one
/// standard deviation of camera or plane) on the angle between them. InputError if the image has more than
/// `most_pixels`, and if the region leaves it or holds no thread; undetermined if the marker does not move.
Quantity plumb_angle(const PlumbSetup& setup, const Restitution& restitution, const MotionAxis& axis,
                     std::optional<cv::Size> image_size, const std::vector<ModeAxis>& modes = {},
                     std::size_t most_pixels = kMostPixels);

}  // namespace glidelab::core
