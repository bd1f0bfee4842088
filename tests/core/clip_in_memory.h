/// A clip whose frames are in memory.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/pictures/frames/frame_source.h"

namespace glidelab::tests {

/// `frames` outlive it.
class ClipInMemory : public core::FrameSource {
 public:
  explicit ClipInMemory(const std::vector<cv::Mat>& frames) : frames_(frames) {}
  std::optional<core::Frame> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    core::Frame frame;
    frame.grey = frames_[next_];
    frame.index = next_++;
    return frame;
  }
  std::size_t stated_frames() const override { return frames_.size(); }
  std::vector<core::Note> notes() const override { return {}; }

 private:
  const std::vector<cv::Mat>& frames_;
  std::size_t next_ = 0;
};

}  // namespace glidelab::tests
