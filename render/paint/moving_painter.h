/// The painter of the moving body, over the exposure, in the rectangle of pixels that it touches; with the glider's
/// outlines.
///
/// Every shape's coverage of a pixel is that of the half-planes that bound it there, each by the exact area that a
/// straight line cuts off the unit square: outlines are projected exactly, the lens is taken as linear within a pixel,
/// and the sphere is taken in quarters of a pixel with its curvature corrected to first order in 1/radius. Light is
/// linear. The exposure is the mean over instants for which the caller gives the body's position and the view. The
/// moments of a marker's image agree with those of individually cast rays to 1e-3 px, for radii from 2.5 px
/// (tests/render/paint/test_moving_painter.cpp). Of the tiles of 8 x 8 pixels, only those that an outline may cross at
/// one of the instants are treated pixel by pixel. A pixel is the same in any requested part of the image.
///
/// This runs on the processor and not in a shader: each of the few thousand pixels of a glider belongs to a few shapes
/// only, and a shader, which does the work of all shapes in each pixel, was measured to be about twenty times slower.
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "render/camera/optics.h"
#include "render/image/float_image.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

/// A line in undistorted coordinates, a x + b y + c, positive inside, of a body shifted by s: fixed + s moving.
struct Edge {
  Eigen::Vector3d fixed;
  Eigen::Vector3d moving;
};

/// A visible face of a box, or a patch on it.
struct Polygon {
  std::array<Edge, 4> edges;
  double radiance = 0.0;
  std::size_t box = 0;
  bool is_patch = false;
  RayBounds bounds;  ///< over all its positions
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

/// How a polygon lies in a tile, for all shifts of a range.
struct InTile {
  bool outside = false;
  std::uint8_t crossing = 0;  ///< bit e: edge e may cross the tile; none: the tile lies entirely within
};
InTile place_in_tile(const Polygon& polygon, const RayBounds& tile, const ShiftRange& shifts);

/// The glider's outlines in one view, in undistorted coordinates, where straight edges are straight lines.
///
/// An outline moves with the body's shift s along the track: the line through the images of p + s d and q + s d is (p +
/// s d) x (q + s d) = p x q + s (p - q) x d, linear in s. So what holds for a line at both ends of a range of shifts
/// holds within it, and a tile of pixels (optics.h) that lies on one side of all lines at both ends is decided without
/// examining its pixels.
///
/// The visible shapes of a body at x_m = middle on its track, plus or minus the shifts. They are in drawing order: a
/// box's faces, then its patches, then the next box. NumericalError if a part is not in front of the camera.
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

/// The body's contribution to the image: pixel = radiance + (1 - coverage) * background.
struct MovingLayer {
  PixelRect rect;               ///< within the image, made of whole tiles; empty if the body is not seen
  std::vector<float> radiance;  ///< times coverage and the table's gain; rect.width * rect.height, row by row
  std::vector<float> coverage;
};

/// The body's mean image over the instants at which it is at `x_m` on its track, within `within`; `rays` belongs to
/// `camera`. NumericalError if a part of the body is not in front of the camera.
MovingLayer paint(const Camera& camera, const RayTable& rays, const MovingBody& body, std::span<const double> x_m,
                  const PixelRect& within);
MovingLayer paint(const Camera& camera, const RayTable& rays, const MovingBody& body, std::span<const double> x_m);

/// One of the instants whose mean is a row of the image.
struct Instant {
  std::size_t view = 0;  ///< index of the view
  double x_m = 0.0;      ///< position on its track
  double weight = 1.0;   ///< of this instant in the row; a row's weights add up to 1
};

/// How each row of a frame is formed: with a rolling shutter each row has its own instants, a shaking camera has
/// several poses, and a camera out of focus sees the body from all points of its aperture.
struct Looks {
  /// From the world to the camera's frame: a pose, plus the shift for a point of the aperture, linear in depth.
  std::vector<Eigen::Affine3d> views;
  double first_x_m = 0.0;  ///< the instants' x_m lie between these two
  double last_x_m = 0.0;
  /// The instants of a row; valid until the next call.
  std::function<std::span<const Instant>(int row)> of_row;
};

/// The body's image, from what each row sees. The sphere stays a sphere in a view that is not rigid.
MovingLayer paint(const RayTable& rays, const MovingBody& body, const Looks& looks, const PixelRect& within);

/// Puts the layer over an image (of radiance, or of any quantity equal to radiance times `scale`).
void put_over(const MovingLayer& layer, float scale, FloatImage& image);

}  // namespace glidelab::render
