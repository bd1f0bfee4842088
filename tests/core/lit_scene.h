/// Matte spheres and discs before a background, for the tests of core/: light from formulas, averaged over samples of
/// each pixel, then a tone curve and noise. It shares no code with the fits.
#pragma once

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/core/painter.h"

namespace glidelab::tests {

struct LitBall {
  cv::Point2d centre;
  double radius_px = 7.0;
  double lamp_x = 0.0, lamp_y = 0.0, lamp_z = 0.0;  ///< right, down, to the camera: strength times direction
  double ambient = 0.1;
  bool is_disc = false;  ///< of the light `ambient`
};

/// Light, 1 at the largest code.
inline double light_of(const LitBall& ball, double u, double v, double behind) {
  const double x = (u - ball.centre.x) / ball.radius_px, y = (v - ball.centre.y) / ball.radius_px;
  const double square = x * x + y * y;
  if (square > 1.0) return behind;
  if (ball.is_disc) return ball.ambient;
  const double cosine = ball.lamp_x * x + ball.lamp_y * y + ball.lamp_z * std::sqrt(1.0 - square);
  return ball.ambient + std::max(0.0, cosine);
}

/// A wall that gets darker to the right, with a bright lamp on it.
inline double wall_light(double u, double v) {
  const double lamp = std::hypot(u - 130.0, v - 55.0) < 14.0 ? 0.9 : 0.0;
  return std::max(lamp, 0.16 - 0.0003 * u + 0.0001 * v);
}

inline double srgb_of_light(double light) {
  const double y = std::clamp(light, 0.0, 1.0);
  return y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1.0 / 2.4) - 0.055;
}

/// 8-bit codes of a scene of light with noise, through sRGB or in proportion to the light.
inline cv::Mat expose_light(cv::Size size, const Light& light, bool srgb, double noise_sd, std::uint64_t seed) {
  cv::Mat image = paint(size, light, 12);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      double& pixel = image.at<double>(v, u);
      pixel = 255.0 * (srgb ? srgb_of_light(pixel) : std::clamp(pixel, 0.0, 1.0));
    }
  }
  return expose(image, noise_sd, seed);
}

}  // namespace glidelab::tests
