/// What frames from a video and from a folder have in common: their size is checked, repeats are counted, and a
/// decoded image becomes a Frame.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {

/// Throws the InputError of one file.
[[noreturn]] void fail_frames(const std::filesystem::path& file, std::string key, std::string found,
                              std::string expected);

/// All frames measure the same, and what was asked for; InputError where one does not.
class SizeCheck {
 public:
  explicit SizeCheck(std::optional<cv::Size> size) : size_(size), given_(size) {}
  void operator()(const cv::Mat& frame, std::size_t index, const std::filesystem::path& file);

 private:
  std::optional<cv::Size> size_;
  bool given_;
};

/// Counts frames that equal the frame before bit by bit: noise does not repeat itself.
class RepeatCounter {
 public:
  void operator()(const cv::Mat& grey);
  std::size_t repeated() const { return repeated_; }
  void tell(std::vector<std::string>& notes) const;

 private:
  bool same_bits(const cv::Mat& grey) const;

  cv::Mat before_;
  std::size_t repeated_ = 0;
  std::size_t count_ = 0;
};

/// A decoded image, grey as stored, and its colours where they are asked for.
Frame make_frame(const cv::Mat& image, bool with_color, std::size_t index);

}  // namespace glidelab::core
