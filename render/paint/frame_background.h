/// The background of a frame: the scene at rest as a camera sees it that moves, and spots of reflected light.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/optics.h"
#include "render/image/float_picture.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario_data.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

/// Fine places to a pixel, along either axis.
inline constexpr int kFine = 4;

/// A scene at rest, seen by a camera that moves.
///
/// The scene is ray-cast once, over a margin around the image and finer than its pixels (kFine to a pixel), and each
/// fine place then holds the mean over a pixel's square about it: what a pixel shows whose ray leads there. A frame
/// takes each pixel from where its ray leads at that instant, bilinearly between fine places. The directions are exact
/// (one projection every 16 px along a row, linear between them); within 1/kFine of a pixel an image is taken as
/// linear, which errs where a straight edge along rows or columns enters a pixel, by 1/(4 kFine) of its contrast at
/// most. A camera that is moved sideways sees parallax: by the depth of what the still camera sees there, so that
/// within a pixel or two of an edge in depth the image is an estimate.
struct FinePicture {
  Camera camera;         ///< at rest, of the image's own size
  RayTable rays;         ///< of it
  int margin_px = 0;     ///< around it
  FloatPicture means;    ///< radiance, a pixel's mean about each fine place
  FloatPicture depth_m;  ///< of the pixel centres, margin included; empty where nothing moves sideways
};

/// How far, in pixels, the image of something at infinity or at `nearest_m` moves at most within `duration_s`: what
/// the margin must hold.
double largest_shift_px(const Camera& camera, const Mount& mount, double duration_s, double nearest_m);

/// NumericalError where the lens has no rays for the margin.
FinePicture fine_picture(const Camera& camera, const Mount& mount, const std::optional<Focus>& focus,
                         const StaticScene& scene, double duration_s);

/// Adds weight times the radiance of pixels [x, x + values.size()) of the row y, the camera being moved by `moved`
/// (render/camera/camera.h). std::logic_error where a ray leads beyond the margin.
void add_row(const FinePicture& fine, const Eigen::Isometry3d& moved, int y, int x, float weight,
             std::span<float> values);

/// Adds the spot, `white_e` for a radiance of 1, to the pixels of `within`; gives the pixels that it changed.
///
/// A spot (render/scenario/scenario_data.h) is in the image a Gaussian about the projection of its middle, with the
/// standard deviation radius · focal/Z along both axes; each pixel gets its exact integral over the pixel. It is drawn
/// up to six standard deviations. During the exposure it moves; with a rolling shutter it is taken at the time of its
/// middle's row, without shear.
PixelRect add_reflection(const Scenario& scenario, const RayTable& rays, const sim::Body& body,
                         const Reflection& reflection, const FrameMotion& frame, double white_e,
                         const PixelRect& within, FloatPicture& picture);

}  // namespace glidelab::render
