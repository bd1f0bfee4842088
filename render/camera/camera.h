/// The true camera: a pinhole with a pose, seen through a lens.
///
/// Frames (CONVENTIONS.md): W world, C camera (x right, y down, z forward); p_W = X_WC * p_C. A point at (X, Y, Z)_C
/// has the undistorted coordinates (x, y) = (X/Z, Y/Z), the lens moves it to (x_d, y_d) (render/camera/lens.h), and it
/// appears at the pixel (u, v) = (fx x_d + cx, fy y_d + cy); the centre of the first pixel is (0, 0).
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "render/camera/lens.h"

namespace glidelab::render {

struct Camera {
  int width_px = 0;
  int height_px = 0;
  Eigen::Vector2d focal_px = Eigen::Vector2d::Zero();   ///< fx, fy
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();  ///< principal point cx, cy
  Lens lens;
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
};

/// Undistorted coordinates of a pixel, or nothing (see above).
std::optional<Eigen::Vector2d> undistorted_at(const Camera& camera, const Eigen::Vector2d& pixel);

/// The pixel at which undistorted coordinates appear; also outside the image. Nothing beyond the fold radius.
std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& undistorted);

/// The same with `largest_radius` in place of the fold radius, for a caller who asks many times.
std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& undistorted,
                                        double largest_radius);

/// The pixel at which a point of the world appears; also outside the image. Nothing for a point behind the camera or
/// beyond the fold radius.
std::optional<Eigen::Vector2d> project(const Camera& camera, const Eigen::Vector3d& p_W);

/// Whether a pixel position lies on the image, at least `margin_px` inside its outermost pixel centres.
bool in_picture(const Camera& camera, const Eigen::Vector2d& pixel, double margin_px = 0.0);

/// X_WC of a camera at `position_W` that looks at `target_W` with the world's +y upward in the image, then turned by
/// `roll_rad` about its optical axis, clockwise as seen from behind the camera. The line of sight must not be vertical.
Eigen::Isometry3d look_at(const Eigen::Vector3d& position_W, const Eigen::Vector3d& target_W, double roll_rad);

/// Why the lens does not map rays one to one on the whole image (with half a pixel around it), or nothing where it
/// does: every point of the image must have an inverse that Newton's method reaches, with a positive Jacobian, inside
/// the fold radius; checked along the border and on a grid of at most 16 px.
std::optional<std::string> why_not_one_to_one(const Camera& camera);

}  // namespace glidelab::render
