/// A camera as the analysis fits it: pinhole, then radial and tangential distortion (Brown 1966, as OpenCV writes it),
/// or a fisheye.
///
/// A point (X, Y, Z) in the camera's frame C (x right, y down, z forward) has the normalised coordinates x = X/Z,
/// y = Y/Z; with r2 = x^2 + y^2
///
///     x' = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 x y + p2 (r2 + 2 x^2)
///     y' = y (1 + k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 y^2) + 2 p2 x y
///     u = fx x' + cx,   v = fy y' + cy
///
/// With a fisheye (equidistant, Kannala and Brandt 2006, as OpenCV writes it), theta = atan(r):
///
///     (x', y') = (x, y) / r theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
///
/// for directions less than 90 degrees off the axis.
///
/// Pixels; the centre of the first pixel is (0, 0).
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <array>
#include <optional>

namespace glidelab::core {

enum class LensKind { brown_conrady, fisheye };

struct CameraModel {
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3; of a fisheye k1, k2, k3, k4, 0
  cv::Size size;                       ///< of the images
  LensKind lens = LensKind::brown_conrady;

  /// The camera with these changes of fx, fy, cx, cy and the distortion.
  CameraModel moved(const Eigen::Matrix<double, 9, 1>& change) const;

  /// From normalised coordinates to pixels.
  cv::Point2d to_pixel(cv::Point2d normalised) const;

  /// From a pixel to normalised coordinates, by Newton's method to 1e-10 px; empty where the distortion folds over and
  /// no ray belongs to the pixel.
  std::optional<cv::Point2d> to_normalised(cv::Point2d pixel) const;
};

}  // namespace glidelab::core
