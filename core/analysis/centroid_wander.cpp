#include "core/analysis/centroid_wander.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math/dense.h"
#include "base/math/distributions.h"

namespace glidelab::core {
namespace {

constexpr int kTerms = static_cast<int>(kWanderModes) + 1;  // with the constant
using Terms = Eigen::Matrix<double, kTerms, 1>;
constexpr std::size_t kFewestShifts = 40;
constexpr double kSignificance = 0.01;  // of modes whose scatter is independent from frame to frame

double cosine(std::size_t k, double part) {
  return std::cos(static_cast<double>(k) * std::numbers::pi * part);
}

}  // namespace

double CentroidWander::at(std::size_t mode, double x_m) const {
  return sd_m * cosine(mode + 1, (x_m - from_m) / length_m);
}

std::optional<CentroidWander> centroid_wander(const std::vector<CentroidShift>& shifts) {
  if (shifts.size() < kFewestShifts) return std::nullopt;
  const auto [least, most] =
      std::ranges::minmax_element(shifts, [](const auto& a, const auto& b) { return a.x_m < b.x_m; });
  CentroidWander wander{least->x_m, most->x_m - least->x_m, 0.0};
  if (!(wander.length_m > 0.0)) return std::nullopt;
  const auto row_of = [&](const CentroidShift& shift) {
    Terms row;
    for (int k = 0; k < kTerms; ++k)
      row[k] = cosine(static_cast<std::size_t>(k), (shift.x_m - wander.from_m) / wander.length_m);
    return row;
  };
  Eigen::Matrix<double, kTerms, kTerms> a = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Terms b = Terms::Zero();
  for (const CentroidShift& shift : shifts) {
    const Terms row = row_of(shift);
    a += row * row.transpose();
    b += shift.shift_m * row;
  }
  const Terms found = base::solve_positive(a, b);
  const Eigen::Matrix<double, kTerms, kTerms> inverse = base::inverse_positive(a);
  if (!found.allFinite() || !inverse.allFinite()) return std::nullopt;
  double squares = 0.0;
  for (const CentroidShift& shift : shifts) squares += std::pow(shift.shift_m - row_of(shift).dot(found), 2);
  const double variance = squares / static_cast<double>(shifts.size() - kTerms);
  const double modes = found.tail<kTerms - 1>().squaredNorm();
  const double by_scatter = variance * inverse.diagonal().tail<kTerms - 1>().sum();
  const double limit =
      base::chi2_upper_quantile(static_cast<double>(kWanderModes), kSignificance) / static_cast<double>(kWanderModes);
  if (!(modes > limit * by_scatter)) return std::nullopt;
  wander.sd_m = std::sqrt((modes - by_scatter) / static_cast<double>(kWanderModes));
  return wander;
}

}  // namespace glidelab::core
