/// A small painter for the tests of core/: images with exactly known geometry, by area averaging of point samples. It
/// shares no code with render/.
#pragma once

#include <opencv2/core.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <opencv2/imgproc.hpp>

namespace glidelab::tests {

/// A scene as light over the continuous image plane (the centre of the first pixel is (0, 0)).
using Light = std::function<double(double u, double v)>;

/// Mean of samples x samples points in every pixel, after a Gaussian blur (sd in pixels); 64-bit float image.
inline cv::Mat paint(cv::Size size, const Light& light, int samples = 8, double blur_px = 0.0) {
  const int margin = blur_px > 0.0 ? static_cast<int>(std::ceil(5.0 * blur_px)) : 0;
  const cv::Size fine_size((size.width + 2 * margin) * samples, (size.height + 2 * margin) * samples);
  cv::Mat fine(fine_size, CV_32F);
  for (int y = 0; y < fine.rows; ++y) {
    auto* row = fine.ptr<float>(y);
    for (int x = 0; x < fine.cols; ++x) {
      row[x] = static_cast<float>(light((x + 0.5) / samples - 0.5 - margin, (y + 0.5) / samples - 0.5 - margin));
    }
  }
  if (blur_px > 0.0) {
    const double sd = blur_px * samples;
    const int width = 2 * static_cast<int>(std::ceil(5.0 * sd)) + 1;
    cv::GaussianBlur(fine, fine, cv::Size(width, width), sd, sd, cv::BORDER_REPLICATE);
  }
  cv::Mat coarse;
  cv::resize(fine, coarse, cv::Size(size.width + 2 * margin, size.height + 2 * margin), 0, 0, cv::INTER_AREA);
  coarse = coarse(cv::Rect(margin, margin, size.width, size.height));
  cv::Mat image;
  coarse.convertTo(image, CV_64F);
  return image;
}

/// Rounds to 8 or 16 bits after adding Gaussian noise of this standard deviation.
inline cv::Mat expose(const cv::Mat& image, double noise_sd, std::uint64_t seed, int depth = CV_8U) {
  cv::Mat noisy = image.clone();
  if (noise_sd > 0.0) {
    cv::RNG random(seed);
    cv::Mat noise(image.size(), CV_64F);
    random.fill(noise, cv::RNG::NORMAL, 0.0, noise_sd);
    noisy += noise;
  }
  cv::Mat rounded;
  noisy.convertTo(rounded, depth);
  return rounded;
}

/// A chessboard in its own plane: inner corner (i, j) at (i, j), squares of side 1, a white margin of 0.7. The corner
/// square beside inner corner (0, 0) is black (`black_first`) or white.
inline double board_light(double x, double y, int columns, int rows, bool black_first = true, double white = 200.0,
                          double black = 25.0, double wall = 110.0) {
  if (x < -1.7 || y < -1.7 || x > columns + 0.7 || y > rows + 0.7) return wall;
  if (x < -1.0 || y < -1.0 || x >= columns || y >= rows) return white;
  const int parity = (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) & 1;
  return (parity == 0) == black_first ? black : white;
}

/// Maps points with a homography.
inline cv::Point2d map(const cv::Matx33d& h, double x, double y) {
  const cv::Vec3d p = h * cv::Vec3d(x, y, 1.0);
  return {p[0] / p[2], p[1] / p[2]};
}

}  // namespace glidelab::tests
