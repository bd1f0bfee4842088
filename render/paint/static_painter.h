/// Renders what stands still, once for each set-up, by ray casting in a fragment shader.
///
/// A pixel is the mean of the radiance over its square, by rays through the exact inverse of the lens: 4 where all is
/// even (found by a first pass), and where it changes within the pixel or its neighbours 16, or 64 at edges. They are
/// the first points of the Sobol sequence, so that an edge along rows or columns has 64 levels too; the chessboard is
/// moreover filtered over each ray's own share of the pixel, so that its edges are exact to about 1e-3 of their
/// contrast.
#pragma once

#include <functional>
#include <optional>

#include "render/camera/focus.h"
#include "render/camera/ray_table.h"
#include "render/paint/float_canvas.h"
#include "render/scenario/static_scene.h"

namespace glidelab::render {

class StaticPainter {
 public:
  /// `rays` belongs to `camera`. One painter a thread. With `focus`, pixels near anything that changes are the mean of
  /// 256 rays, from all over the lens's aperture and the core's Gaussian (the same in each pixel).
  StaticPainter(const Camera& camera, const RayTable& rays, const std::optional<Focus>& focus = std::nullopt);

  /// Relative radiance, times the table's gain, in the size of the image.
  FloatPicture paint(const StaticScene& scene);

  /// The same, from `empty`, the image of the scene without its board and plumb line: only what these may change is
  /// drawn. (With `focus` the pixels elsewhere have as many rays as `empty` needed.)
  FloatPicture paint_before(const FloatPicture& empty, const StaticScene& scene);

 private:
  void show(const StaticScene& scene);
  void draw_tiles(const StaticScene& scene, const PixelRect& within,
                  const std::function<bool(const PixelRect&)>& is_wanted);
  FloatPicture cast_rays(const StaticScene& scene, const PixelRect& within, int reach_px);
  int blur_reach_px(const StaticScene& scene) const;

  Camera camera_;
  std::optional<Focus> focus_;
  FloatCanvas canvas_;
  std::vector<float> gain_;
  int wanted_unit_ = 0;  ///< the texture that says which pixels get all rays
};

}  // namespace glidelab::render
