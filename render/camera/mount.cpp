#include "render/camera/mount.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glidelab::render {

Eigen::Isometry3d mount_at(const Mount& mount, double t_s) {
  std::array<double, 6> value{};
  for (const MountMotion& motion : mount.motions) {
    value[static_cast<std::size_t>(motion.axis)] +=
        motion.offset + motion.drift_per_s * t_s +
        motion.amplitude * std::sin(2.0 * std::numbers::pi * motion.frequency_hz * t_s + motion.phase_rad);
  }
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.translation() = Eigen::Vector3d(value[0], value[1], value[2]);
  moved.linear() =
      (Eigen::AngleAxisd(value[3], Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(value[4], Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(value[5], Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  return moved;
}

double picture_shift_px(const Camera& camera, const Eigen::Isometry3d& moved) {
  double largest = 0.0;
  const double right = camera.width_px - 1.0;
  const double bottom = camera.height_px - 1.0;
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(0.5 * right, 0.5 * bottom), Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(right, 0.0),
        Eigen::Vector2d(0.0, bottom), Eigen::Vector2d(right, bottom)}) {
    const auto ray = undistorted_at(camera, pixel);
    if (!ray) continue;
    const Eigen::Vector3d there = moved * Eigen::Vector3d(ray->homogeneous());
    if (const auto shifted = pixel_of(camera, there.hnormalized())) {
      largest = std::max(largest, (*shifted - pixel).norm());
    }
  }
  return largest;
}

}  // namespace glidelab::render
