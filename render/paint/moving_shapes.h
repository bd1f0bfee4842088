/// The glider's outlines as one view sees them, in undistorted coordinates, where straight edges are straight lines.
///
/// An outline moves with the body's shift s along the track: the line through the images of p + s d and q + s d is
/// (p + s d) x (q + s d) = p x q + s (p - q) x d, linear in s. So what holds of a line at both ends of a range of
/// shifts holds within it, and a tile of pixels (ray_table.h) that lies on one side of all lines at both ends is
/// decided without a look at its pixels.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/camera/ray_table.h"
#include "render/scenario/moving_body.h"

namespace glidelab::render {

/// A line in undistorted coordinates, a x + b y + c, positive inside, of a body shifted by s: fixed + s moving.
struct Edge {
  Eigen::Vector3d fixed;
  Eigen::Vector3d moving;
};

/// A seen face of a box, or a patch on it.
struct Polygon {
  std::array<Edge, 4> edges;
  double radiance = 0.0;
  std::size_t box = 0;
  bool is_patch = false;
  RayBounds bounds;  ///< of all its places
};

struct Sphere {
  Eigen::Vector3d center_C;
  double radius_m = 0.0;
  double radiance = 0.0;
  RayBounds bounds;
};

struct ShiftRange {
  double first = 0.0;
  double last = 0.0;
};

/// How a polygon lies in a tile at all shifts of a range.
struct InTile {
  bool outside = false;
  std::uint8_t crossing = 0;  ///< bit e: edge e may cross the tile; none: the tile lies wholly within
};
InTile place_in_tile(const Polygon& polygon, const RayBounds& tile, const ShiftRange& shifts);

/// What a view shows of a body that stands at x_m = middle on its track, give or take the shifts. In the order in which
/// they are drawn: a box's faces, then its patches, the next box. NumericalError where a part is not before the camera.
class Shapes {
 public:
  Shapes(const Eigen::Affine3d& X_CW, const MovingBody& body, double middle_m, const ShiftRange& shifts);

  const std::vector<Polygon>& polygons() const { return polygons_; }
  const std::optional<Sphere>& sphere() const { return sphere_; }
  const Eigen::Vector3d& direction_C() const { return direction_C_; }
  const RayBounds& bounds() const { return bounds_; }  ///< of all

 private:
  void add_box(const MovingBox& box, std::size_t number);
  void add_polygon(const std::array<Eigen::Vector3d, 4>& corners_C, double radiance, std::size_t box, bool is_patch);
  void add_sphere(const MarkerSphere& marker);
  void bound(RayBounds& bounds, const Eigen::Vector3d& p_C) const;

  Eigen::Affine3d X_CW_;
  Eigen::Vector3d shift_W_;
  Eigen::Vector3d direction_C_;
  ShiftRange shifts_;
  std::vector<Polygon> polygons_;
  std::optional<Sphere> sphere_;
  RayBounds bounds_;
};

}  // namespace glidelab::render
