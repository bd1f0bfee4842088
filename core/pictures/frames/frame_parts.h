/// What frames from a video and frames from a folder have in common: their size is checked, repeats are counted, and a
/// decoded picture becomes a Frame.
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

/// Counts frames that are the picture before them once more, bit by bit: noise does not repeat itself.
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

/// A decoded picture, grey as stored, and its colours where they are asked for.
Frame make_frame(const cv::Mat& picture, bool with_color, std::size_t index);

/// The two kinds of source that open_frames chooses between; `size` as there.
std::unique_ptr<FrameSource> open_video(const std::filesystem::path& file, const CameraSettings& camera,
                                        bool with_color, std::optional<cv::Size> size);
std::unique_ptr<FrameSource> open_frame_folder(const std::filesystem::path& folder, const CameraSettings& camera,
                                               bool with_color, std::optional<cv::Size> size);

}  // namespace glidelab::core
