/// The exact inverse of the camera's mapping at every pixel, its derivative there, and how much light gets there.
///
/// For the pixel (u, v) the table gives the undistorted coordinates (x, y) of the ray through its centre, and the
/// Jacobian d(x, y)/d(u, v). Within a pixel the mapping is taken as linear; the neglected second order is below
/// |d²x/du²|/8, 3e-5 px for the strongest lens that `why_not_one_to_one` lets pass in an image of 800 px. Computed in
/// double and rounded once to single precision: 2^-25 of half the image's width, 1e-5 px.
#pragma once

#include <limits>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/vignetting.h"
#include "render/image/float_picture.h"

namespace glidelab::render {

/// A rectangle in undistorted coordinates; empty until something is added.
struct RayBounds {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
};

inline void add_to(RayBounds& bounds, const Eigen::Vector2d& point) {
  bounds.low = bounds.low.cwiseMin(point);
  bounds.high = bounds.high.cwiseMax(point);
}
inline void add_to(RayBounds& bounds, const RayBounds& other) {
  bounds.low = bounds.low.cwiseMin(other.low);
  bounds.high = bounds.high.cwiseMax(other.high);
}
inline bool overlap(const RayBounds& a, const RayBounds& b) {
  return a.low.x() <= b.high.x() && b.low.x() <= a.high.x() && a.low.y() <= b.high.y() && b.low.y() <= a.high.y();
}

/// The image is cut into tiles of kRayTile x kRayTile pixels, from its first pixel on.
inline constexpr int kRayTile = 8;

struct RayTable {
  int width = 0;
  int height = 0;
  std::vector<float> x_y_dxdu_dxdv;  ///< four floats a pixel
  std::vector<float> dydu_dydv;      ///< two floats a pixel
  std::vector<float> gain;           ///< one a pixel, of its light; empty where it is 1 everywhere
  std::vector<RayBounds> tiles;      ///< what the pixels of each tile see, their whole squares; row by row
  double fold_radius = 0.0;          ///< of the lens

  const RayBounds& tile(int column, int row) const {
    return tiles[static_cast<std::size_t>(row) * ((width + kRayTile - 1) / kRayTile) + column];
  }
};

/// NumericalError where a pixel has no ray (a camera that `why_not_one_to_one` would refuse).
RayTable make_ray_table(const Camera& camera, const Vignetting& vignetting = {});

}  // namespace glidelab::render
