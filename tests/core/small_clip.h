/// Small clips for the tests of core/: a disc that moves over a painted background, as a video or a folder of frames.
#pragma once

#include <opencv2/core.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/core/painter.h"

namespace glidelab::tests {

/// Puts an opaque disc with a soft edge (Gaussian, sd `blur_px`) into the image; 8 x 8 samples a pixel.
inline void put_disc(cv::Mat& image, cv::Point2d centre, double radius, double value, double blur_px = 0.4) {
  constexpr int kSamples = 8;
  const double reach = radius + 5.0 * blur_px + 1.0;
  for (int v = static_cast<int>(std::floor(centre.y - reach)); v <= centre.y + reach; ++v) {
    for (int u = static_cast<int>(std::floor(centre.x - reach)); u <= centre.x + reach; ++u) {
      if (u < 0 || v < 0 || u >= image.cols || v >= image.rows) continue;
      double share = 0.0;
      for (int j = 0; j < kSamples; ++j) {
        for (int i = 0; i < kSamples; ++i) {
          const double du = u + (i + 0.5) / kSamples - 0.5 - centre.x;
          const double dv = v + (j + 0.5) / kSamples - 0.5 - centre.y;
          share += 0.5 * std::erfc((std::hypot(du, dv) - radius) / (std::sqrt(2.0) * blur_px));
        }
      }
      share /= kSamples * kSamples;
      double& pixel = image.at<double>(v, u);
      pixel = pixel * (1.0 - share) + value * share;
    }
  }
}

inline void put_box(cv::Mat& image, cv::Rect box, double value) {
  image(box & cv::Rect(0, 0, image.cols, image.rows)).setTo(value);
}

/// Writes frames (CV_64F, or CV_64FC3) as FFV1 in Matroska with 8 bits; noise of this standard deviation is added.
inline void write_video(const std::filesystem::path& path, const std::vector<cv::Mat>& frames, double rate_hz,
                        double noise_sd = 1.0, const std::string& codec = "FFV1") {
  const bool color = frames.front().channels() == 3;
  cv::VideoWriter writer(path.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]),
                         rate_hz, frames.front().size(), color);
  if (!writer.isOpened()) throw std::runtime_error("no writer for " + path.string());
  std::uint64_t seed = 1;
  for (const cv::Mat& frame : frames) {
    cv::Mat flat = frame.reshape(1);
    writer.write(expose(flat, noise_sd, seed++).reshape(frame.channels()));
  }
}

inline void write_folder(const std::filesystem::path& folder, const std::vector<cv::Mat>& frames, double noise_sd,
                         int depth) {
  std::filesystem::create_directories(folder);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    char name[32];
    std::snprintf(name, sizeof name, "%06zu.png", k);
    cv::imwrite((folder / name).string(), expose(frames[k], noise_sd, k + 1, depth));
  }
}

}  // namespace glidelab::tests
