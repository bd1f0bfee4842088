/// A thin dark or bright thread in a region of a picture.
///
/// Row by row (column by column where it runs more along the picture's rows) its places are found as what stands out
/// from both sides; the straight line (after the lens's distortion is undone) that most of them lie on is the thread.
/// It is then fitted as a whole (core/thread_fit.h).
#pragma once

#include <opencv2/core.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace glidelab::core {

/// The thread's middle in each row (or column) in which it is seen, and the same with the thread turned by one standard
/// deviation of its direction; pixels. Empty where there is no thread.
struct ThreadInPicture {
  std::vector<cv::Point2d> points;
  std::vector<cv::Point2d> turned;
  std::size_t rows = 0;  ///< that the fit rests on
};

/// `straight` undoes the lens. The region lies inside the picture, which is grey of 8 or 16 bits.
ThreadInPicture find_thread(const cv::Mat& grey, cv::Rect region,
                            const std::function<std::optional<cv::Point2d>(cv::Point2d)>& straight);

}  // namespace glidelab::core
