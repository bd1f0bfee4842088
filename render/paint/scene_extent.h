/// Where in the image the parts of a scene are: rectangles of pixels that hold them.
#pragma once

#include "render/camera/camera.h"
#include "render/image/float_picture.h"
#include "render/scenario/static_scene.h"

namespace glidelab::render {

/// The whole image where a part of the box's edges is not before the camera.
PixelRect pixels_of(const Camera& camera, const StaticBox& box);

/// The pixels that the board and the plumb line may change, with `reach_px` around; empty without either.
PixelRect pixels_before(const Camera& camera, const StaticScene& scene, int reach_px);

}  // namespace glidelab::render
