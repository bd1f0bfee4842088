/// The painter of the static scene, once for each set-up, by ray casting in a fragment shader: where its parts are in
/// the image, how many rays are cast at each pixel, and where they go.
///
/// A pixel is the mean of the radiance over its square, by rays through the exact inverse of the lens: 4 in uniform
/// regions (found by a first pass), 16 where the radiance changes within the pixel or its neighbours, and 64 at edges.
/// They are the first points of the Sobol sequence, so that an edge along rows or columns also has 64 levels; the
/// chessboard is in addition filtered over each ray's own share of the pixel, so that its edges are exact to about 1e-3
/// of their contrast.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/optics.h"
#include "render/image/float_image.h"
#include "render/paint/float_canvas.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

/// The rectangle of pixels that contains the box. The whole image if part of the box's edges is not in front of the
/// camera.
PixelRect pixels_of(const Camera& camera, const StaticBox& box);

/// The pixels that the board and the plumb line may change, with `reach_px` around; empty without either.
PixelRect pixels_before(const Camera& camera, const StaticScene& scene, int reach_px);

/// How many rays each pixel needs (0, 16 or 64): determined by the change within the pixel (`spread`) or against a
/// neighbour, for the pixel itself or one of its neighbours.
FloatImage wanted_rays(const FloatImage& image, const FloatImage& spread);

/// The first 64 points of the Sobol sequence in two dimensions, within [0, 1)²: the first 16 of them, or all, have one
/// point in every column and row of as many.
std::vector<Eigen::Vector2f> pixel_places();

/// Four numbers for each of kFocusRays rays: its point of the aperture in metres and its part of the core in
/// undistorted coordinates; then, in a second row, its position in the pixel.
std::vector<float> lens_rays(const Focus& focus, const Camera& camera);

class StaticPainter {
 public:
  /// `rays` belongs to `camera`. One painter per thread. With `focus`, pixels near any change are the mean of 256 rays
  /// from the whole aperture of the lens and the core's Gaussian (the same in each pixel).
  StaticPainter(const Camera& camera, const RayTable& rays, const std::optional<Focus>& focus = std::nullopt);

  /// Relative radiance, times the table's gain, in the size of the image.
  FloatImage paint(const StaticScene& scene);

  /// The same, made from `empty`, the image of the scene without its board and plumb line: only pixels that these may
  /// change are drawn. (With `focus` the other pixels have as many rays as `empty` needed.) In both images a radiance
  /// of 1 corresponds to `white`.
  FloatImage paint_before(const FloatImage& empty, const StaticScene& scene, double white = 1.0);

 private:
  void show(const StaticScene& scene);
  void draw_tiles(const StaticScene& scene, const PixelRect& within,
                  const std::function<bool(const PixelRect&)>& is_wanted);
  FloatImage cast_rays(const StaticScene& scene, const PixelRect& within, int reach_px);
  int blur_reach_px(const StaticScene& scene) const;

  Camera camera_;
  std::optional<Focus> focus_;
  FloatCanvas canvas_;
  std::vector<float> gain_;
  int wanted_unit_ = 0;  ///< the texture that marks the pixels with all rays
};

}  // namespace glidelab::render
