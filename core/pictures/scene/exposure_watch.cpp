#include "core/pictures/scene/exposure_watch.h"

namespace glidelab::core {
namespace {

constexpr int kPixelStep = 4;          // rows, and columns, from one pixel looked at to the next
constexpr std::size_t kFrameStep = 5;  // frames
constexpr double kBright = 0.999;      // share of the pixels that are darker

}  // namespace

void ExposureWatch::add(const Frame& frame) {
  if (frame.index % kFrameStep != 0) return;
  const cv::Mat& grey = frame.grey;
  const bool narrow = grey.depth() == CV_8U;
  if (count_.empty()) count_.resize(narrow ? 256 : 65536);
  for (int row = 0; row < grey.rows; row += kPixelStep) {
    for (int column = 0; column < grey.cols; column += kPixelStep) {
      ++count_[narrow ? grey.at<std::uint8_t>(row, column) : grey.at<std::uint16_t>(row, column)];
      ++pixels_;
    }
  }
}

Exposure ExposureWatch::result() const {
  Exposure exposure;
  if (pixels_ == 0) return exposure;
  std::size_t largest = count_.size() - 1;
  while (count_[largest] == 0) --largest;
  // 8 bits are filled, whatever the camera has. Of 16 those that the camera has, unless the codes say otherwise.
  exposure.full_code = static_cast<int>(count_.size()) - 1;
  if (count_.size() > 256 && largest < std::size_t{1} << bit_depth_) exposure.full_code = (1 << bit_depth_) - 1;
  const auto all = static_cast<double>(pixels_);
  if (largest == static_cast<std::size_t>(exposure.full_code)) {
    exposure.saturated = static_cast<double>(count_[largest]) / all;
  }
  exposure.dark = static_cast<double>(count_[0]) / all;
  std::size_t code = 0, up_to = count_[0];
  while (static_cast<double>(up_to) < kBright * all) up_to += count_[++code];
  exposure.bright_level = static_cast<double>(code) / exposure.full_code;
  return exposure;
}

}  // namespace glidelab::core
