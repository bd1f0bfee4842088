/// What a still camera sees behind moving objects: the median over frames that are spread through the clip.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace glidelab::core {

/// Whole frames, spread evenly through a clip, in limited memory.
class StillBackground {
 public:
  /// For a clip of `frames` frames.
  explicit StillBackground(std::size_t frames) : clip_frames_(frames) {}

  /// Keeps every n-th frame. All frames must have the same size.
  void add(const cv::Mat& grey, std::size_t frame);

  /// The median of each pixel. Empty if no frame was kept.
  cv::Mat median() const;

  /// Whether a moving object hides a pixel in a frame.
  using Hides = std::function<bool(std::size_t frame, cv::Point pixel)>;
  struct Part {
    cv::Mat codes;       ///< CV_32F: mean of the codes near the median, over frames in which the pixel is not hidden
    cv::Mat known;       ///< CV_8U: not 0 where there are kFewest such frames or more
    double noise = 0.0;  ///< standard deviation of a pixel's code about the background
  };
  Part behind(const cv::Rect& region, const Hides& hides) const;

  static constexpr std::size_t kFewest = 4;

 private:
  struct Kept {
    std::size_t frame;
    cv::Mat grey;
  };
  std::size_t clip_frames_;
  std::vector<Kept> kept_;
};

}  // namespace glidelab::core
