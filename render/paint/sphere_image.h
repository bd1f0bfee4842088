/// The exact image of a sphere.
///
/// A sphere of radius r about c (camera frame) fills the cone of rays d with (d·c)² >= (|c|² - r²) |d|². On the plane
/// z = 1 of undistorted coordinates that is an ellipse, whose centre is not the projection of the sphere's centre. The
/// lens then bends the ellipse; the photometric centre of the image is the centroid of the bent area.
#pragma once

#include <optional>

#include "render/camera/camera.h"

namespace glidelab::render {

/// In undistorted coordinates: points center + axis_u cos(t) + axis_v sin(t).
struct Ellipse {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis_u = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis_v = Eigen::Vector2d::Zero();
};

/// Empty if the sphere is not entirely in front of the camera (c.z <= r).
std::optional<Ellipse> image_of_sphere(const Eigen::Vector3d& center_C, double radius_m);

struct AreaMoments {
  double area_px = 0.0;  ///< in square pixels
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
};

/// Area and centroid of an ellipse's image under the lens: the integrals of 1 and of the pixel position over the
/// ellipse with the mapping's Jacobian, by Gauss-Legendre in the radius and the trapezoid rule in the angle (exact
/// within rounding for the polynomials of a lens).
AreaMoments image_of(const Camera& camera, const Ellipse& ellipse);

}  // namespace glidelab::render
