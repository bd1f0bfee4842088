/// A camera that does not keep still, and one whose focus was changed after the calibration.
///
/// Each motion is along or about one of the camera's own axes: X_WC(t) = X_WC T(x, y, z) R_y(pan) R_x(tilt) R_z(roll),
/// where each of the six is the sum over the motions of that axis of
///
///     offset + drift t + amplitude sin(2 pi f t + phase),
///
/// t counted from the clip's first exposure. The calibration's images are taken with all six at 0, and with the focal
/// length that the camera's section says; the clips with (1 + focal_change) of it.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "render/camera/camera.h"

namespace glidelab::render {

enum class MountAxis { x, y, z, pan, tilt, roll };

/// In metres for x, y and z, in radians for the others.
struct MountMotion {
  MountAxis axis = MountAxis::pan;
  double offset = 0.0;
  double drift_per_s = 0.0;
  double amplitude = 0.0;
  double frequency_hz = 0.0;
  double phase_rad = 0.0;
};

struct Mount {
  double focal_change = 0.0;
  std::vector<MountMotion> motions;

  bool moves() const { return !motions.empty(); }
};

/// What the mount does to the camera at an instant: X_WC(t) = X_WC * this.
Eigen::Isometry3d mount_at(const Mount& mount, double t_s);

/// How far the image's middle and corners move, at most, when a camera is moved so; for what is 1 m away or farther.
double picture_shift_px(const Camera& camera, const Eigen::Isometry3d& moved);

}  // namespace glidelab::render
