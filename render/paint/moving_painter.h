/// Draws what moves, over the exposure, in the rectangle of pixels that it touches.
///
/// Every shape's coverage of a pixel is that of the half-planes that bound it there, each by the exact area that a
/// straight line cuts off the unit square: outlines are projected exactly, the lens is taken as linear within a pixel,
/// and the sphere is taken in quarters of a pixel with its curvature corrected to first order in 1/radius. Light is
/// linear. The exposure is the mean over the instants at which the caller says where the body is, and whence it is
/// seen. The moments of a marker's image are those of rays cast one by one to 1e-3 px, for radii from 2.5 px
/// (tests/render/paint/test_moving_painter.cpp). Of tiles of 8 x 8 pixels only those that an outline may cross at one
/// of the instants are looked at pixel by pixel. A pixel is the same in any part of the image that is asked for.
///
/// This runs on the processor and not in a shader: of the few thousand pixels of a glider each belongs to a few shapes
/// only, and a shader, which does all the shapes' work in each pixel, was measured to be some twenty times slower.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "render/camera/ray_table.h"
#include "render/image/float_picture.h"
#include "render/scenario/moving_body.h"

namespace glidelab::render {

/// What the body adds to the image: pixel = radiance + (1 - coverage) * what stands behind.
struct MovingLayer {
  PixelRect rect;               ///< within the image, whole tiles of it; empty where the body is not seen
  std::vector<float> radiance;  ///< times coverage and the table's gain; rect.width * rect.height, row by row
  std::vector<float> coverage;
};

/// The body's mean image over the instants at which it is at `x_m` on its track, within `within`; `rays` belongs to
/// `camera`. NumericalError where a part of the body is not before the camera.
MovingLayer paint(const Camera& camera, const RayTable& rays, const MovingBody& body, std::span<const double> x_m,
                  const PixelRect& within);
MovingLayer paint(const Camera& camera, const RayTable& rays, const MovingBody& body, std::span<const double> x_m);

/// One of the instants of which a row of the image is the mean.
struct Instant {
  std::size_t view = 0;  ///< whence the body is seen
  double x_m = 0.0;      ///< where it is on its track
  double weight = 1.0;   ///< of this instant in the row; a row's weights add up to 1
};

/// How each row of a frame comes about: with a rolling shutter each has instants of its own, a camera that shakes has
/// several poses, and one whose lens is out of focus sees the body from all over its aperture.
struct Looks {
  /// From the world to the camera's frame: a pose, and what a point of the aperture adds, linear in the depth.
  std::vector<Eigen::Affine3d> views;
  double first_x_m = 0.0;  ///< the instants' x_m lie between these two
  double last_x_m = 0.0;
  /// The instants of a row; valid until the next call.
  std::function<std::span<const Instant>(int row)> of_row;
};

/// The body's image by what each row sees. The sphere stays a sphere in a view that is not rigid.
MovingLayer paint(const RayTable& rays, const MovingBody& body, const Looks& looks, const PixelRect& within);

/// Puts the layer over an image (of radiance, or of anything that radiance times `scale` is).
void put_over(const MovingLayer& layer, float scale, FloatPicture& picture);

}  // namespace glidelab::render
