/// The background of a frame: the scene at rest as seen by a moving camera, and spots of reflected light.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/optics.h"
#include "render/image/float_image.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario_data.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

/// Fine positions per pixel, along either axis.
inline constexpr int kFine = 4;

/// A scene at rest, seen by a moving camera.
///
/// The scene is ray-cast once, including a margin around the image and finer than its pixels (kFine per pixel). Each
/// fine position then holds the mean over a pixel's square about it, i.e. the value of a pixel whose ray leads there. A
/// frame takes each pixel from the position to which its ray leads at that instant, with bilinear interpolation between
/// fine positions. The directions are exact (one projection every 16 px along a row, linear between them); within
/// 1/kFine of a pixel an image is taken as linear; if a straight edge along rows or columns enters a pixel, the error
/// is at most 1/(4 kFine) of its contrast. A camera that is moved sideways sees parallax: it is computed from the depth
/// seen by the still camera, so that within a pixel or two of an edge in depth the image is an estimate.
struct FineImage {
  Camera camera;       ///< at rest, of the image's own size
  RayTable rays;       ///< of it
  int margin_px = 0;   ///< around it
  FloatImage means;    ///< radiance, a pixel's mean about each fine position
  FloatImage depth_m;  ///< of the pixel centres, including the margin; empty if the camera does not move sideways
};

/// How far, in pixels, the image of something at infinity or at `nearest_m` moves at most within `duration_s`: the
/// margin must cover this.
double largest_shift_px(const Camera& camera, const Mount& mount, double duration_s, double nearest_m);

/// NumericalError if the lens has no rays for the margin.
FineImage fine_image(const Camera& camera, const Mount& mount, const std::optional<Focus>& focus,
                     const StaticScene& scene, double duration_s);

/// Adds weight times the radiance of pixels [x, x + values.size()) of the row y, the camera being moved by `moved`
/// (render/camera/camera.h). std::logic_error if a ray leads beyond the margin.
void add_row(const FineImage& fine, const Eigen::Isometry3d& moved, int y, int x, float weight,
             std::span<float> values);

/// Adds the spot, with `white_e` for a radiance of 1, to the pixels of `within`; returns the rectangle of changed
/// pixels.
///
/// A spot (render/scenario/scenario_data.h) is a Gaussian in the image about the projection of its middle, with
/// standard deviation radius · focal/Z along both axes; each pixel gets its exact integral over the pixel. It is drawn
/// up to six standard deviations. During the exposure it moves; with a rolling shutter it is drawn at the time of its
/// middle's row, without shear.
PixelRect add_reflection(const Scenario& scenario, const RayTable& rays, const sim::Body& body,
                         const Reflection& reflection, const FrameMotion& frame, double white_e,
                         const PixelRect& within, FloatImage& image);

}  // namespace glidelab::render
