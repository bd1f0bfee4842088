#include "render/paint/scene_extent.h"

#include <algorithm>
#include <cmath>

namespace glidelab::render {
namespace {

constexpr double kMarginPx = 6.0;  // for what a long edge bulges between its points, and the rays of pixels beside it

/// The rectangle that holds the images of points, with a margin; the whole image where one of them has none.
class Extent {
 public:
  explicit Extent(const Camera& camera) : camera_(camera) {}

  void add(const Eigen::Vector3d& p_W) {
    const auto pixel = project(camera_, p_W);
    if (!pixel) {
      is_whole_ = true;
      return;
    }
    low_ = low_.cwiseMin(*pixel);
    high_ = high_.cwiseMax(*pixel);
  }
  /// The lens bends long edges: points all along.
  void add_edge(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W) {
    constexpr int kSteps = 16;
    for (int i = 0; i <= kSteps; ++i) add(from_W + (to_W - from_W) * (static_cast<double>(i) / kSteps));
  }
  void add(const StaticBox& box) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(box.turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 4; ++corner) {
        Eigen::Vector3d sign;
        sign[axis] = -1.0;
        sign[(axis + 1) % 3] = (corner & 1) != 0 ? 1.0 : -1.0;
        sign[(axis + 2) % 3] = (corner & 2) != 0 ? 1.0 : -1.0;
        const Eigen::Vector3d from = box.center_W + turn * sign.cwiseProduct(box.half_m);
        sign[axis] = 1.0;
        add_edge(from, box.center_W + turn * sign.cwiseProduct(box.half_m));
      }
    }
  }
  PixelRect rect(int more_px = 0) const {
    const PixelRect all{0, 0, camera_.width_px, camera_.height_px};
    if (is_whole_) return all;
    const auto whole = [](double value) { return static_cast<int>(std::floor(std::clamp(value, -1e6, 1e6))); };
    const double margin = kMarginPx + more_px;
    return intersection(
        all, {whole(low_.x() - margin), whole(low_.y() - margin), whole(high_.x() - low_.x() + 2 * margin) + 1,
              whole(high_.y() - low_.y() + 2 * margin) + 1});
  }

 private:
  const Camera& camera_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(1e9), high_ = Eigen::Vector2d::Constant(-1e9);
  bool is_whole_ = false;
};

}  // namespace

PixelRect pixels_of(const Camera& camera, const StaticBox& box) {
  Extent extent(camera);
  extent.add(box);
  return extent.rect();
}

PixelRect pixels_before(const Camera& camera, const StaticScene& scene, int reach_px) {
  Extent extent(camera);
  if (scene.board) {
    const std::vector<Eigen::Vector3d> outline = outline_of(*scene.board);
    for (std::size_t i = 0; i < outline.size(); ++i) extent.add_edge(outline[i], outline[(i + 1) % outline.size()]);
  }
  if (scene.plumb) {
    const PlumbLine& plumb = *scene.plumb;
    const double radius = 0.5 * std::max(plumb.diameter_m, plumb.bob_diameter_m);
    const double bottom = plumb.bottom_y_m - plumb.bob_diameter_m;
    StaticBox around;
    around.center_W = {plumb.x_m, 0.5 * (plumb.top_y_m + bottom), plumb.z_m};
    around.half_m = {radius, 0.5 * (plumb.top_y_m - bottom), radius};
    extent.add(around);
  }
  return extent.rect(reach_px);
}

}  // namespace glidelab::render
