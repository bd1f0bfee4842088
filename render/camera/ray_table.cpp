#include "render/camera/ray_table.h"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.h"

namespace glidelab::render {
namespace {

/// What the pixels of a rectangle see, each to its square's corners.
RayBounds seen_in(const RayTable& table, const PixelRect& rect) {
  RayBounds bounds;
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    for (int u = rect.x; u < rect.x + rect.width; ++u) {
      const std::size_t at = static_cast<std::size_t>(v) * table.width + u;
      const float* const ray = table.x_y_dxdu_dxdv.data() + 4 * at;
      const float* const slope = table.dydu_dydv.data() + 2 * at;
      const Eigen::Vector2d middle(ray[0], ray[1]);
      const Eigen::Vector2d reach =
          0.5 * Eigen::Vector2d(std::abs(ray[2]) + std::abs(ray[3]), std::abs(slope[0]) + std::abs(slope[1]));
      add_to(bounds, RayBounds{middle - reach, middle + reach});
    }
  }
  return bounds;
}

}  // namespace

RayTable make_ray_table(const Camera& camera, const Vignetting& vignetting) {
  RayTable table;
  table.width = camera.width_px;
  table.height = camera.height_px;
  const auto pixels = static_cast<std::size_t>(camera.width_px) * camera.height_px;
  table.x_y_dxdu_dxdv.reserve(pixels * 4);
  table.dydu_dydv.reserve(pixels * 2);
  const Eigen::Matrix2d per_pixel = camera.focal_px.cwiseInverse().asDiagonal();
  const double largest_radius = fold_radius(camera.lens);
  table.fold_radius = largest_radius;
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const std::optional<Eigen::Vector2d> ray = undistort(
          camera.lens, (Eigen::Vector2d(u, v) - camera.center_px).cwiseQuotient(camera.focal_px), largest_radius);
      if (!ray) throw base::NumericalError(fmt::format("lens: no ray leads to the pixel ({}, {})", u, v));
      const Eigen::Matrix2d slope = distortion_jacobian(camera.lens, *ray).inverse() * per_pixel;
      for (const double value : {ray->x(), ray->y(), slope(0, 0), slope(0, 1)}) {
        table.x_y_dxdu_dxdv.push_back(static_cast<float>(value));
      }
      for (const double value : {slope(1, 0), slope(1, 1)}) table.dydu_dydv.push_back(static_cast<float>(value));
      if (!vignetting.none()) {
        table.gain.push_back(static_cast<float>(gain_at(vignetting, camera, Eigen::Vector2d(u, v), *ray)));
      }
    }
  }
  for (int v = 0; v < table.height; v += kRayTile) {
    for (int u = 0; u < table.width; u += kRayTile) {
      table.tiles.push_back(
          seen_in(table, intersection({u, v, kRayTile, kRayTile}, {0, 0, table.width, table.height})));
    }
  }
  return table;
}

}  // namespace glidelab::render
