#include "core/result/estimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/math/quantile.h"

namespace glidelab::core {

double student_t975(double degrees) {
  assert(degrees >= 1.0);
  constexpr double z = kNormal95;
  if (!std::isfinite(degrees)) return z;
  // Quantile p = 0.975 in closed form at 1 and 2 degrees (tan(pi (p - 1/2)); sqrt 2 (2p-1) / sqrt(4p(1-p)) · …);
  // between 1 and 3 the logarithm is interpolated.
  constexpr double t1 = 12.706204736174694, t2 = 4.302652729749464, t3 = 3.182446305283708;
  if (degrees < 2.0) return std::exp(std::log(t1) + (degrees - 1.0) * std::log(t2 / t1));
  if (degrees < 3.0) return std::exp(std::log(t2) + (degrees - 2.0) * std::log(t3 / t2));
  const double z2 = z * z, n = 1.0 / degrees;
  const double g1 = (z2 + 1.0) * z / 4.0;
  const double g2 = ((5.0 * z2 + 16.0) * z2 + 3.0) * z / 96.0;
  const double g3 = (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) * z / 384.0;
  const double g4 = ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) * z / 92160.0;
  return z + n * (g1 + n * (g2 + n * (g3 + n * g4)));
}

Estimate estimate(double value, double sd, double degrees) {
  const double half = student_t975(degrees) * sd;
  return {value, sd, value - half, value + half};
}

double chi2_ratio_limit(double degrees) {
  const double variance = 2.0 / (9.0 * std::max(1.0, degrees));
  return std::pow(1.0 - variance + 3.0 * std::sqrt(variance), 3);
}

Quantity determined(const Estimate& estimate, std::optional<double> noise_sd) {
  Quantity quantity{estimate, {}};
  quantity.noise_sd = noise_sd;
  return quantity;
}

Quantity undetermined(std::string why) {
  return {std::nullopt, std::move(why)};
}

}  // namespace glidelab::core
