/// What moves along the track, as the moving painter draws it: boxes, flat patches on them, and the marker's sphere.
///
/// All positions are in the world frame for the body at x = 0 on the track; at x it stands shifted by x * direction_W.
/// The painter draws the boxes in the given order, each over the ones before, and the marker over all of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace glidelab::render {

/// A rectangle on a face of a box: `corners_W` in order around it.
struct Patch {
  std::array<Eigen::Vector3d, 4> corners_W;
  double radiance = 0.0;
};

struct MovingBox {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes_W = Eigen::Matrix3d::Identity();  ///< columns: the box's own right-handed axes
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();      ///< half its size along them
  std::array<double, 6> radiance{};                      ///< of the faces at -x, +x, -y, +y, -z, +z
  std::vector<Patch> patches;                            ///< drawn on it; seen where the box is seen
};

/// A sphere that shines evenly (retro-reflective sheeting under a light beside the lens).
struct MarkerSphere {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
  double radiance = 0.0;
};

struct MovingBody {
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitX();  ///< the track's +x, of length 1
  std::vector<MovingBox> boxes;
  std::optional<MarkerSphere> marker;
};

}  // namespace glidelab::render
