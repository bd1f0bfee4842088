#include "render/video/video_writer.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <vector>

#include "base/errors.h"
#include "base/files/staged_output.h"
#include "render/video/libav_writer.h"

namespace glidelab::render {
namespace {

class PngFolderWriter final : public VideoWriter {
 public:
  PngFolderWriter(std::filesystem::path folder, const VideoFormat& format)
      : folder_(std::move(folder)), format_(format) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) base::throw_system_error(folder_.string(), "cannot be made", error.value());
  }

  void write(std::span<const std::uint8_t> frame) override { write_as(frame, CV_8U); }
  void write(std::span<const std::uint8_t>, double) override {
    throw std::logic_error("a folder of images has no times");
  }
  void write(std::span<const std::uint16_t> frame) override { write_as(frame, CV_16U); }
  void finish() override {}

 private:
  template <typename Code>
  void write_as(std::span<const Code> frame, int type) {
    if (frame.size() != static_cast<std::size_t>(format_.width) * format_.height) {
      throw std::logic_error(
          fmt::format("a frame of {} codes for {} x {}", frame.size(), format_.width, format_.height));
    }
    // imwrite takes const data by a cv::Mat that it does not change.
    const cv::Mat image(format_.height, format_.width, type, const_cast<Code*>(frame.data()));
    write_png(folder_ / fmt::format("{:06d}.png", next_++), image);
  }

  std::filesystem::path folder_;
  VideoFormat format_;
  int next_ = 0;
};

}  // namespace

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  // Encoded in memory and written by write_file, which sees a full disk at the write and at the close.
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
    throw base::EnvironmentError(fmt::format("{}: PNG encoder failed", path.string()));
  }
  base::write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::unique_ptr<VideoWriter> open_video(const std::filesystem::path& path, const VideoFormat& format) {
  if (format.codec == Codec::png) return std::make_unique<PngFolderWriter>(path, format);
  return open_libav(path, format);
}

}  // namespace glidelab::render
