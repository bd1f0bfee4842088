#include "diagnose/fit/projected_motion.h"

#include <algorithm>

namespace glidelab::diagnose {

OwnColumns own_columns(const FitMotion& motion) {
  OwnColumns own;
  own.scale = (motion.own.colwise().squaredNorm().transpose().array() + 1e-300).sqrt().inverse();
  own.scaled = motion.own * own.scale.asDiagonal();
  Eigen::MatrixXd normal = base::transposed_product(own.scaled, own.scaled);
  normal.diagonal().array() += 1e-12;
  own.gain = base::solve_positive(normal, own.scaled.transpose());
  return own;
}

Eigen::MatrixXd without_own(const FitMotion& motion, const base::MatrixView& columns) {
  const OwnColumns own = own_columns(motion);
  return columns - base::product(own.scaled, base::product(own.gain, columns));
}

ProjectedMotion project(const FitMotion& motion) {
  ProjectedMotion result;
  result.residual = without_own(motion, motion.residual);
  result.common = without_own(motion, motion.global);
  double points = 0.0;
  for (Eigen::Index p = 0; p < motion.own.rows(); ++p) points += motion.own(p, 0) != 0.0 ? 1.0 : 0.0;
  result.freedom = std::max(0.0, points - static_cast<double>(motion.own.cols()));
  return result;
}

void CommonNormal::add(const ProjectedMotion& motion, double sign) {
  matrix += sign * base::transposed_product(motion.common, motion.common);
  right += sign * base::transposed_product(motion.common, motion.residual);
}

CommonNormal without_clip(const TrackSet& set, CommonNormal all, const std::vector<ProjectedMotion>& motions,
                          std::size_t clip) {
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (set.motions[i].clip == clip) all.add(motions[i], -1.0);
  }
  return all;
}

CommonNormal statements_normal(const MotionFit& fit) {
  const auto n = fit.at.global.size();
  CommonNormal normal{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const FitStatement& s : fit.statements) {
    const auto g = static_cast<Eigen::Index>(s.global);
    normal.matrix(g, g) += 1.0 / (s.sd * s.sd);
    normal.right[g] += (s.value - fit.at.global[g]) / (s.sd * s.sd);
  }
  return normal;
}

Eigen::MatrixXd inverse_normal(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scale = (matrix.diagonal().array() + 1e-30).sqrt().inverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  scaled.diagonal().array() += 1e-12;
  const Eigen::MatrixXd inverse = base::inverse_positive(scaled);
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace glidelab::diagnose
