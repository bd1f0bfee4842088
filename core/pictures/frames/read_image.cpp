#include "core/pictures/frames/read_image.h"

#include <stdlib.h>

#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

#include "base/errors.h"
#include "core/pictures/frames/image_size.h"

namespace glidelab::core {
namespace fs = std::filesystem;

void silence_opencv() {
  static std::once_flag once;
  std::call_once(once, [] {
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // AV_LOG_QUIET; a user's own setting stays
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  });
}

cv::Mat read_image(const fs::path& path, std::size_t most_pixels) {
  silence_opencv();
  const auto fail = [&](const std::string& found) {
    throw base::InputError(base::Issue{path.string(), 0, "", found, "an image (PNG, JPEG, TIFF, BMP, PGM)"});
  };
  std::error_code error;
  if (!fs::is_regular_file(path, error)) fail("no file");
  if (fs::file_size(path, error) == 0) fail("an empty file");
  const auto size = stated_image_size(path);
  if (!size) fail("no image that can be decoded");
  check_pixels(path, "", size->width, size->height, most_pixels);
  check_pixels(path, "tile", size->part_width, size->part_height, most_pixels);
  cv::Mat image;
  try {
    image = cv::imread(path.string(), cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH);
  } catch (const cv::Exception& exception) {
    fail("an image that cannot be decoded (" + std::string(exception.err) + ")");
  }
  if (image.empty()) fail("no image that can be decoded");
  if (image.depth() != CV_8U && image.depth() != CV_16U) fail("an image of neither 8 nor 16 bits");
  return image;
}

cv::Mat to_grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

cv::Mat read_grey_image(const fs::path& path, std::size_t most_pixels) {
  return to_grey(read_image(path, most_pixels));
}

}  // namespace glidelab::core
