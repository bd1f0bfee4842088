/// How much darker the image is towards its corners.
///
/// cos⁴: the illumination of a flat sensor behind a simple lens, cos⁴ of the angle between the ray and the optical
/// axis. Radial: a table of gains over the distance from the principal point in pixels, linear between its entries;
/// it multiplies the former. Applied to the light, before the sensor.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/camera/camera.h"

namespace glidelab::render {

struct Vignetting {
  bool cos4 = false;
  std::vector<Eigen::Vector2d> radial;  ///< (radius_px, gain), radii rising from 0 to beyond the farthest corner

  bool none() const { return !cos4 && radial.empty(); }
};

/// The gain at a pixel to which the ray with these undistorted coordinates leads. std::logic_error beyond the table.
double gain_at(const Vignetting& vignetting, const Camera& camera, const Eigen::Vector2d& pixel,
               const Eigen::Vector2d& undistorted);

/// The largest distance of a pixel's centre from the principal point.
double farthest_radius_px(const Camera& camera);

}  // namespace glidelab::render
