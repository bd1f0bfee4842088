#include "render/camera/optics.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/errors.h"

namespace glidelab::render {
namespace {

/// Thin lens: the distance from lens to sensor.
double image_distance_m(const Focus& focus, const Camera& camera) {
  return 0.5 * (camera.focal_px.x() + camera.focal_px.y()) * focus.pixel_pitch_m;
}

double focal_length_m(const Focus& focus, const Camera& camera) {
  const double s = image_distance_m(focus, camera);
  return s * focus.focus_distance_m / (s + focus.focus_distance_m);
}

/// Makes the mean of v vᵀ over the samples `variance` times the identity.
template <typename Part>
void whiten(std::vector<FocusSample>& samples, const Part& part, double variance) {
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (FocusSample& sample : samples) {
    covariance += part(sample) * part(sample).transpose() / static_cast<double>(samples.size());
  }
  const Eigen::Matrix2d lower = covariance.llt().matrixL();
  const Eigen::Matrix2d to_white = std::sqrt(variance) * lower.inverse();
  for (FocusSample& sample : samples) part(sample) = to_white * part(sample).eval();
}

}  // namespace

double aperture_radius_m(const Focus& focus, const Camera& camera) {
  return 0.5 * focal_length_m(focus, camera) / focus.f_number;
}

double disc_radius_px(const Focus& focus, const Camera& camera, double depth_m) {
  return aperture_radius_m(focus, camera) * std::abs(1.0 / depth_m - 1.0 / focus.focus_distance_m) * 0.5 *
         (camera.focal_px.x() + camera.focal_px.y());
}

double core_sigma_px(const Focus& focus, const Camera& camera) {
  const double magnified = image_distance_m(focus, camera) / focal_length_m(focus, camera);
  const double diffraction = 0.42 * focus.wavelength_m * focus.f_number * magnified / focus.pixel_pitch_m;
  return std::hypot(diffraction, focus.core_px);
}

std::vector<FocusSample> focus_samples(std::size_t count) {
  if (count < 8 || count % 2 != 0) throw std::logic_error("focus_samples: an even number from 8");
  // The root of x^7 = x + 1: powers of its inverse are the steps of the sequence in six dimensions.
  double phi = 1.2;
  for (int i = 0; i < 60; ++i) phi = std::pow(1.0 + phi, 1.0 / 7.0);
  const auto part = [&](std::size_t i, int dimension) {
    const double at = 0.5 + static_cast<double>(i + 1) * std::pow(phi, -dimension);
    return at - std::floor(at);
  };
  std::vector<FocusSample> samples;
  for (std::size_t i = 0; i < count / 2; ++i) {
    const double turn = 2.0 * std::numbers::pi * part(i, 1);
    const double radius = std::sqrt(part(i, 2));
    const double core_turn = 2.0 * std::numbers::pi * part(i, 3);
    const double core_radius = std::sqrt(-2.0 * std::log(1.0 - part(i, 4)));
    FocusSample sample;
    sample.aperture = radius * Eigen::Vector2d(std::cos(turn), std::sin(turn));
    sample.core = core_radius * Eigen::Vector2d(std::cos(core_turn), std::sin(core_turn));
    sample.place = {part(i, 5) - 0.5, part(i, 6) - 0.5};
    samples.push_back(sample);
    samples.push_back({-sample.aperture, -sample.core, -sample.place});
  }
  whiten(
      samples, [](FocusSample& s) -> Eigen::Vector2d& { return s.aperture; }, 0.25);
  whiten(
      samples, [](FocusSample& s) -> Eigen::Vector2d& { return s.core; }, 1.0);
  return samples;
}

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

namespace {

/// The rays seen by the pixels of a rectangle, each out to the corners of its square.
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
