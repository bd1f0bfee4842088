/// What a camera that keeps still sees behind the things that move: the median over frames spread through the clip.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace glidelab::core {

/// Frames spread evenly through a clip, whole, in a limited memory.
class StillBackground {
 public:
  /// Of a clip of `frames` frames.
  explicit StillBackground(std::size_t frames) : clip_frames_(frames) {}

  /// Keeps every n-th frame; all are of one size.
  void add(const cv::Mat& grey, std::size_t frame);

  /// The median of each pixel.
  cv::Mat median() const;

  /// In which frames something that moves hides a pixel.
  using Hides = std::function<bool(std::size_t frame, cv::Point pixel)>;
  struct Part {
    cv::Mat
        codes;  ///< CV_32F: the mean of the codes next to the median, of the frames in which nothing hides the pixel
    cv::Mat known;       ///< CV_8U: not 0 where there are kFewest of them
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
