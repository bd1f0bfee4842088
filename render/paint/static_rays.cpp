#include "render/paint/static_rays.h"

#include <algorithm>
#include <cmath>

#include "render/paint/static_shader.h"

namespace glidelab::render {
namespace {

// Radiance, of white: what may change within a pixel that gets 4 rays, or 16. The mean is then good to some 1e-3, a
// quarter of a code of 8 bits.
constexpr float kUneven = 0.006f;
constexpr float kEdge = 0.04f;

}  // namespace

FloatPicture wanted_rays(const FloatPicture& picture, const FloatPicture& spread) {
  FloatPicture change = spread;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const float here = picture.at(x, y);
      float& most = change.at(x, y);
      if (x + 1 < picture.width) most = std::max(most, std::abs(picture.at(x + 1, y) - here));
      if (y + 1 < picture.height) most = std::max(most, std::abs(picture.at(x, y + 1) - here));
    }
  }
  FloatPicture wanted(picture.width, picture.height);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (change.at(x, y) <= kUneven) continue;
      const float rays = change.at(x, y) > kEdge ? 64.0f : 16.0f;
      for (int v = std::max(0, y - 1); v < std::min(picture.height, y + 2); ++v) {
        for (int u = std::max(0, x - 1); u < std::min(picture.width, x + 2); ++u) {
          wanted.at(u, v) = std::max(wanted.at(u, v), rays);
        }
      }
    }
  }
  return wanted;
}

std::vector<Eigen::Vector2f> pixel_places() {
  std::vector<Eigen::Vector2f> points;
  for (unsigned i = 0; i < kPixelRays; ++i) {
    unsigned x = 0;
    unsigned y = 0;
    unsigned direction = 32;
    for (unsigned bit = 0; bit < 6; ++bit, direction ^= direction >> 1) {
      if (((i >> bit) & 1u) == 0) continue;
      x ^= 32u >> bit;
      y ^= direction;
    }
    points.emplace_back(static_cast<float>(x) / kPixelRays, static_cast<float>(y) / kPixelRays);
  }
  return points;
}

std::vector<float> lens_rays(const Focus& focus, const Camera& camera) {
  const double aperture_m = aperture_radius_m(focus, camera);
  const double core = core_sigma_px(focus, camera);
  std::vector<float> values;
  for (const FocusSample& sample : focus_samples(kFocusRays)) {
    const Eigen::Vector2d a = aperture_m * sample.aperture;
    const Eigen::Vector2d g = core * sample.core.cwiseQuotient(camera.focal_px);
    for (const double value : {a.x(), a.y(), g.x(), g.y()}) values.push_back(static_cast<float>(value));
  }
  for (const FocusSample& sample : focus_samples(kFocusRays)) {
    for (const double value : {sample.place.x(), sample.place.y(), 0.0, 0.0}) {
      values.push_back(static_cast<float>(value));
    }
  }
  return values;
}

}  // namespace glidelab::render
