/// A painted image as a colour camera records it: Bayer mosaic, OpenCV's interpolation, the curve of ITU-R BT.709.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <random>

namespace glidelab::tests {

/// From light (CV_64F, 0 to 255) to codes of 8 bits. `interpolation`: cv::COLOR_BayerRG2BGR (bilinear) or
/// cv::COLOR_BayerRG2BGR_EA (along edges). The scene has no colours and the camera is balanced, so that every pixel of
/// the mosaic sees the light as it is, with noise of this standard deviation (of 255).
inline cv::Mat through_mosaic(const cv::Mat& light, int interpolation, bool curved, double noise_sd, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0.0, noise_sd);
  cv::Mat raw(light.size(), CV_16U);
  for (int v = 0; v < raw.rows; ++v) {
    for (int u = 0; u < raw.cols; ++u) {
      raw.at<unsigned short>(v, u) =
          cv::saturate_cast<unsigned short>(257.0 * (light.at<double>(v, u) + noise(engine)));
    }
  }
  cv::Mat colors, grey, codes(light.size(), CV_8U);
  cv::demosaicing(raw, colors, interpolation);
  cv::cvtColor(colors, grey, cv::COLOR_BGR2GRAY);
  for (int v = 0; v < codes.rows; ++v) {
    for (int u = 0; u < codes.cols; ++u) {
      const double x = grey.at<unsigned short>(v, u) / 65535.0;
      const double y = !curved ? x : x < 0.018 ? 4.5 * x : 1.099 * std::pow(x, 0.45) - 0.099;
      codes.at<unsigned char>(v, u) = cv::saturate_cast<unsigned char>(255.0 * y);
    }
  }
  return codes;
}

}  // namespace glidelab::tests
