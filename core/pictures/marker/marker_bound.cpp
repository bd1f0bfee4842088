#include "core/pictures/marker/marker_bound.h"

#include <Eigen/Dense>

#include <cmath>

#include "core/pictures/image/pixel_edge.h"

namespace glidelab::core {
namespace {

enum Parameter {
  kDiscU,
  kDiscV,
  kDiscRadius,
  kDiscBlur,
  kDiscBright,
  kDiscLevel,
  kDiscSlopeU,
  kDiscSlopeV,
  kDiscParameters
};
using Vector = Eigen::Matrix<double, kDiscParameters, 1>;

double pixel_of(const Vector& p, double u, double v) {
  const double du = u - p[kDiscU], dv = v - p[kDiscV];
  const double distance = std::max(std::hypot(du, dv), 1e-9);
  const double edge = pixel_edge(p[kDiscRadius] - distance, du / distance, dv / distance, p[kDiscBlur]).value;
  const double behind = p[kDiscLevel] + p[kDiscSlopeU] * du + p[kDiscSlopeV] * dv;
  return behind + (p[kDiscBright] - behind) * edge;
}

}  // namespace

double least_centre_sd_px(const DiscImage& disc, double reach_px) {
  Vector p;
  p << disc.u, disc.v, disc.radius_px, disc.blur_px, disc.amplitude, 0.0, 0.0, 0.0;
  Eigen::Matrix<double, kDiscParameters, kDiscParameters> information;
  information.setZero();
  // Central differences: pixels, grey values; the third derivative's share is 1e-6 of the first.
  constexpr double kStep = 1e-3;
  for (int v = static_cast<int>(std::ceil(disc.v - reach_px)); v <= disc.v + reach_px; ++v) {
    for (int u = static_cast<int>(std::ceil(disc.u - reach_px)); u <= disc.u + reach_px; ++u) {
      if (std::hypot(u - disc.u, v - disc.v) > reach_px) continue;
      Vector slope;
      for (int k = 0; k < kDiscParameters; ++k) {
        Vector up = p, down = p;
        up[k] += kStep;
        down[k] -= kStep;
        slope[k] = (pixel_of(up, u, v) - pixel_of(down, u, v)) / (2.0 * kStep);
      }
      information += slope * slope.transpose() / (disc.noise_sd * disc.noise_sd);
    }
  }
  const Eigen::Matrix<double, kDiscParameters, kDiscParameters> bound = information.inverse();
  return std::sqrt(0.5 * (bound(kDiscU, kDiscU) + bound(kDiscV, kDiscV)));
}

}  // namespace glidelab::core
