#include "core/pictures/camera/left_out_terms.h"

#include <algorithm>
#include <cmath>

#include "base/math/dense.h"

namespace glidelab::core {

double believed(double usual, double sd) {
  return usual * usual / (usual * usual + sd * sd);
}

Eigen::Matrix<double, 9, 9> effect_of(const std::vector<LeftOutTerm>& all, double kept_at_corner) {
  constexpr double kSdsOfLeftOutK1 = 2.0;  // standard deviations
  double extent = kept_at_corner;
  for (const LeftOutTerm& one : all) {
    if (one.power == 1) extent += one.at_corner * (std::abs(one.value[0]) + kSdsOfLeftOutK1 * std::sqrt(one.own(0, 0)));
  }
  Eigen::Matrix<double, 9, 9> effect = Eigen::Matrix<double, 9, 9>::Zero();
  for (const LeftOutTerm& one : all) {
    double part = 1.0;
    if (one.power > 0) {
      // The extent of a lens without k1 comes from k1 itself, which therefore says nothing about k1.
      const double usual = one.power > 1 ? std::min(one.usual, one.of_extent * extent) : one.usual;
      part = believed(usual, one.at_corner * std::sqrt(one.own(0, 0)));
    }
    const Eigen::VectorXd weighted = base::solve_positive(one.own, one.value);
    const double statistic = part * one.value.dot(weighted);
    const double real = std::max(0.0, 1.0 - static_cast<double>(one.value.size()) / std::max(statistic, 1e-300));
    const Eigen::VectorXd moved = part * base::product(one.with_others, weighted);
    effect += part * base::product(one.with_others, base::solve_positive(one.own, one.with_others.transpose())) +
              real * base::product(moved, moved.transpose());
  }
  return effect;
}

}  // namespace glidelab::core
