/// A thin dark or bright thread in a region of an image.
///
/// Row by row (column by column if it runs more along the rows) its candidate positions are those that stand out from
/// both sides; the straight line (with the lens's distortion undone) on which most of them lie is the thread. It is
/// then fitted as a whole (thread_fit.h).
#pragma once

#include <opencv2/core.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace glidelab::core {

/// The middle of the thread in each row (or column) in which it is seen, and the same with the thread turned by one
/// standard deviation of its direction; pixels. Empty if there is no thread.
struct ThreadInImage {
  std::vector<cv::Point2d> points;
  std::vector<cv::Point2d> turned;
  std::size_t rows = 0;  ///< used by the fit
};

/// `straight` undoes the lens. The region lies inside the image, which is grey of 8 or 16 bits.
ThreadInImage find_thread(const cv::Mat& grey, cv::Rect region,
                          const std::function<std::optional<cv::Point2d>(cv::Point2d)>& straight);

}  // namespace glidelab::core
