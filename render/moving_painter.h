/// Draws what moves, over the exposure, in the rectangle of pixels that it touches.
///
/// Every shape's coverage of a pixel is that of the half-planes that bound it there, each by the exact area that a
/// straight line cuts off the unit square: outlines are projected exactly, the lens is taken as linear within a pixel,
/// and the sphere is taken in quarters of a pixel with its curvature corrected to first order in 1/radius. Light is
/// linear. The exposure is the mean over the instants at which the caller says where the body is. The moments of a
/// marker's picture are those of rays cast one by one to 1e-3 px, for radii from 2.5 px
/// (tests/render/test_moving_painter.cpp).
///
/// This runs on the processor and not in a shader: of the few thousand pixels of a glider each belongs to a few shapes
/// only, and a shader, which does all the shapes' work in each pixel, was measured to be some twenty times slower.
#pragma once

#include <span>
#include <vector>

#include "render/moving_body.h"
#include "render/picture.h"
#include "render/ray_table.h"

namespace glidelab::render {

/// What the body adds to the picture: pixel = radiance + (1 - coverage) * what stands behind.
struct MovingLayer {
  PixelRect rect;               ///< within the picture; empty where the body is not seen
  std::vector<float> radiance;  ///< times coverage; rect.width * rect.height, row by row
  std::vector<float> coverage;
};

/// The body's mean picture over the instants at which it is at `x_m` on its track; `rays` belongs to `camera`.
/// NumericalError where a part of the body is not before the camera.
MovingLayer paint(const Camera& camera, const RayTable& rays, const MovingBody& body, std::span<const double> x_m);

/// Puts the layer over a picture (of radiance, or of anything that radiance times `scale` is).
void put_over(const MovingLayer& layer, float scale, FloatPicture& picture);

}  // namespace glidelab::render
