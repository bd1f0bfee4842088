#include "core/pictures/frames/frame_parts.h"

#include <fmt/format.h>

#include <cstring>

#include "base/errors.h"
#include "core/pictures/frames/read_image.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

std::string show(cv::Size size) {
  return fmt::format("{} x {} pixels", size.width, size.height);
}

}  // namespace

void fail_frames(const fs::path& file, std::string key, std::string found, std::string expected) {
  throw base::InputError(base::Issue{file.string(), 0, std::move(key), std::move(found), std::move(expected)});
}

void SizeCheck::operator()(const cv::Mat& frame, std::size_t index, const fs::path& file) {
  if (!size_) size_ = frame.size();
  if (frame.size() == *size_) return;
  fail_frames(file, fmt::format("frame {}", index), show(frame.size()),
              show(*size_) + (given_ ? ", as the views of the pattern" : ", as the frames before"));
}

void RepeatCounter::operator()(const cv::Mat& grey) {
  if (!before_.empty() && same_bits(grey)) ++repeated_;
  before_ = grey;
  ++count_;
}

void RepeatCounter::tell(std::vector<std::string>& notes) const {
  if (repeated_ == 0) return;
  notes.push_back(
      fmt::format("{} of {} frames are identical to the frame before: duplicates (a camera or converter that repeats "
                  "frames), or a scene at rest without any noise",
                  repeated_, count_));
}

bool RepeatCounter::same_bits(const cv::Mat& grey) const {
  if (grey.size() != before_.size() || grey.type() != before_.type()) return false;
  const std::size_t bytes = static_cast<std::size_t>(grey.cols) * grey.elemSize();
  for (int row = 0; row < grey.rows; ++row) {
    if (std::memcmp(grey.ptr(row), before_.ptr(row), bytes) != 0) return false;
  }
  return true;
}

Frame make_frame(const cv::Mat& image, bool with_color, std::size_t index) {
  Frame frame;
  frame.index = index;
  frame.grey = to_grey(image);
  if (!with_color || image.channels() == 1) return frame;
  if (image.depth() == CV_8U) {
    frame.color = image;
  } else {
    image.convertTo(frame.color, CV_8U, 1.0 / 256.0);
  }
  return frame;
}

}  // namespace glidelab::core
