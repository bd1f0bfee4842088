/// The chessboard's pixels as exact areas: the painter of calibration views, which differ in every run of a study.
///
/// A pixel is a parallelogram on the board, given by the ray through its middle and the lens's derivatives there (the
/// neglected curvature of perspective and lens within a pixel is below 1e-3 of it). Its albedo is the mean over black
/// and white squares, found by clipping the parallelogram at their borders; light and shade, which hardly change within
/// a pixel, are those of its middle. If the plate covers only part of a pixel, the rest of it shows the image without
/// the board.
///
/// The board is unobstructed: nothing hides it or blocks its light (stands_free()). For a lens that is not sharp
/// everywhere see static_painter.h.
#pragma once

#include "render/camera/camera.h"
#include "render/camera/optics.h"
#include "render/image/float_image.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

/// Whether the scene has a board, seen from its printed side, that certainly no box of the scene partly hides or
/// shades.
bool stands_free(const Camera& camera, const StaticScene& scene);

/// The image of the scene with its board, which must be unobstructed (asserted), made from `empty`, the image without
/// it. There a relative radiance of 1 corresponds to `white` (times the gain of the table). `rays` belongs to `camera`.
FloatImage paint_board(const Camera& camera, const RayTable& rays, const FloatImage& empty, const StaticScene& scene,
                       double white);

}  // namespace glidelab::render
