#include "render/camera/camera.h"

#include <fmt/format.h>

#include <cmath>

namespace glidelab::render {
std::optional<Eigen::Vector2d> undistorted_at(const Camera& camera, const Eigen::Vector2d& pixel) {
  return undistort(camera.lens, (pixel - camera.center_px).cwiseQuotient(camera.focal_px));
}

std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& undistorted) {
  return pixel_of(camera, undistorted, fold_radius(camera.lens));
}

std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& undistorted,
                                        double largest_radius) {
  if (!(undistorted.norm() < largest_radius)) return std::nullopt;
  return Eigen::Vector2d(distort(camera.lens, undistorted).cwiseProduct(camera.focal_px) + camera.center_px);
}

std::optional<Eigen::Vector2d> project(const Camera& camera, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_C = camera.X_WC.inverse() * p_W;
  if (!(p_C.z() > 0.0)) return std::nullopt;
  return pixel_of(camera, p_C.head<2>() / p_C.z());
}

bool in_picture(const Camera& camera, const Eigen::Vector2d& pixel, double margin_px) {
  return pixel.x() >= margin_px && pixel.y() >= margin_px && pixel.x() <= camera.width_px - 1 - margin_px &&
         pixel.y() <= camera.height_px - 1 - margin_px;
}

Eigen::Isometry3d look_at(const Eigen::Vector3d& position_W, const Eigen::Vector3d& target_W, double roll_rad) {
  const Eigen::Vector3d forward = (target_W - position_W).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitY()).normalized();
  const Eigen::Vector3d down = forward.cross(right);
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.linear().col(0) = std::cos(roll_rad) * right + std::sin(roll_rad) * down;
  X_WC.linear().col(1) = -std::sin(roll_rad) * right + std::cos(roll_rad) * down;
  X_WC.linear().col(2) = forward;
  X_WC.translation() = position_W;
  return X_WC;
}

std::optional<std::string> why_not_one_to_one(const Camera& camera) {
  const double largest_radius = fold_radius(camera.lens);
  const auto check = [&](double u, double v) {
    const Eigen::Vector2d distorted = (Eigen::Vector2d(u, v) - camera.center_px).cwiseQuotient(camera.focal_px);
    return undistort(camera.lens, distorted, largest_radius).has_value();
  };
  const double right = camera.width_px - 0.5;
  const double bottom = camera.height_px - 0.5;
  const int columns = (camera.width_px + 15) / 16;
  const int rows = (camera.height_px + 15) / 16;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const double u = -0.5 + (right + 0.5) * column / columns;
      const double v = -0.5 + (bottom + 0.5) * row / rows;
      if (!check(u, v)) {
        return fmt::format(
            "a lens that folds the image over (no ray leads to the pixel ({:.1f}, {:.1f}); the mapping "
            "is one to one up to {:.4g} focal lengths off the axis)",
            u, v, largest_radius);
      }
    }
  }
  for (int i = 0; i < camera.width_px; ++i) {
    if (!check(i, -0.5) || !check(i, bottom)) {
      return fmt::format("a lens that folds the image over at column {} of its border", i);
    }
  }
  for (int i = 0; i < camera.height_px; ++i) {
    if (!check(-0.5, i) || !check(right, i)) {
      return fmt::format("a lens that folds the image over at row {} of its border", i);
    }
  }
  return std::nullopt;
}

}  // namespace glidelab::render
