#include "render/camera/focus.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <stdexcept>

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

}  // namespace glidelab::render
