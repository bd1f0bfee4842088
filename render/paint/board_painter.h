/// The chessboard's pixels as exact areas: the painter of calibration views, of which every run of a study has its own.
///
/// A pixel is a parallelogram on the board, by the ray through its middle and the lens's derivatives there (what is
/// left out, how perspective and lens bend within a pixel, is below 1e-3 of it). Its albedo is the mean over it of
/// black and white squares, by clipping the parallelogram at their borders; light and shade, which hardly change within
/// a pixel, are those of its middle. A pixel of which the plate covers a part shows the image without the board in the
/// rest of it.
///
/// The board is by itself: nothing stands before it, or keeps the light from it (stands_free()). For a lens that is not
/// sharp everywhere see static_painter.h.
#pragma once

#include "render/camera/camera.h"
#include "render/camera/optics.h"
#include "render/image/float_picture.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

/// Whether the scene has a board, seen from its printed side, that surely no box of the scene hides in part, or keeps
/// light from.
bool stands_free(const Camera& camera, const StaticScene& scene);

/// The image of the scene with its board, which stands free (asserted), from `empty`, the one without it, in which a
/// relative radiance of 1 is worth `white` (times the gain of the table). `rays` belongs to `camera`.
FloatPicture paint_board(const Camera& camera, const RayTable& rays, const FloatPicture& empty,
                         const StaticScene& scene, double white);

}  // namespace glidelab::render
