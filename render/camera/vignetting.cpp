#include "render/camera/vignetting.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace glidelab::render {

double gain_at(const Vignetting& vignetting, const Camera& camera, const Eigen::Vector2d& pixel,
               const Eigen::Vector2d& undistorted) {
  double gain = 1.0;
  if (vignetting.cos4) {
    const double secant2 = 1.0 + undistorted.squaredNorm();
    gain /= secant2 * secant2;
  }
  if (!vignetting.radial.empty()) {
    const double radius = (pixel - camera.center_px).norm();
    const auto above = std::find_if(vignetting.radial.begin(), vignetting.radial.end(),
                                    [&](const Eigen::Vector2d& entry) { return entry.x() >= radius; });
    if (above == vignetting.radial.end()) {
      throw std::logic_error(fmt::format("vignetting: {} px is beyond the table's last radius", radius));
    }
    if (above == vignetting.radial.begin()) return gain * above->y();
    const Eigen::Vector2d& below = *(above - 1);
    gain *= below.y() + (above->y() - below.y()) * (radius - below.x()) / (above->x() - below.x());
  }
  return gain;
}

double farthest_radius_px(const Camera& camera) {
  double farthest = 0.0;
  for (const double u : {0.0, camera.width_px - 1.0}) {
    for (const double v : {0.0, camera.height_px - 1.0}) {
      farthest = std::max(farthest, (Eigen::Vector2d(u, v) - camera.center_px).norm());
    }
  }
  return farthest;
}

}  // namespace glidelab::render
