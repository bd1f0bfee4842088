/// Spots of reflected light in a frame (render/scenario/light.h).
///
/// A spot's image is a Gaussian about the projection of its middle, with the standard deviation radius · focal/Z
/// along both axes; each pixel gets its exact integral over the pixel. It is drawn up to six standard deviations.
/// During the exposure it moves; with a rolling shutter it is taken at the time of its middle's row, without shear.
#pragma once

#include "render/camera/ray_table.h"
#include "render/image/float_picture.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario_data.h"

namespace glidelab::render {

/// Adds the spot, `white_e` for a radiance of 1, to the pixels of `within`; gives the pixels that it changed.
PixelRect add_reflection(const Scenario& scenario, const RayTable& rays, const sim::Body& body,
                         const Reflection& reflection, const FrameMotion& frame, double white_e,
                         const PixelRect& within, FloatPicture& picture);

}  // namespace glidelab::render
