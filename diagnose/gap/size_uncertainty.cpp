#include "diagnose/gap/size_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/math/dense.h"
#include "diagnose/fit/fit_neighbourhood.h"

namespace glidelab::diagnose {

SizeUncertainty::SizeUncertainty(const TrackSet& set, const MotionFit& fit) {
  const CommonNormal stated = statements_normal(fit);
  CommonNormal all = stated;
  std::map<std::size_t, CommonNormal> parts;
  const CommonNormal nothing{Eigen::MatrixXd::Zero(stated.matrix.rows(), stated.matrix.cols()),
                             Eigen::VectorXd::Zero(stated.right.size())};
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    const ProjectedMotion motion = project(fit.motions[i]);
    all.add(motion);
    parts.try_emplace(set.clips.size() > 1 ? set.motions[i].clip : i, nothing).first->second.add(motion);
  }
  model_ = inverse_normal(all.matrix);
  between_clips_ = Eigen::MatrixXd::Zero(model_.rows(), model_.cols());
  if (parts.size() < 2) return;
  const Eigen::VectorXd shift = base::product(model_, all.right);
  const auto n = static_cast<double>(parts.size());
  Eigen::MatrixXd scatter = stated.matrix;
  for (const auto& [part, of] : parts) {
    const Eigen::VectorXd score = of.right - base::product(of.matrix, shift);
    scatter += n / (n - 1.0) * score * score.transpose();
  }
  between_clips_ = base::product(base::product(model_, scatter), model_);
}

double SizeUncertainty::sd(const Eigen::VectorXd& by) const {
  const Eigen::VectorXd model = base::product(model_, by), between = base::product(between_clips_, by);
  return std::sqrt(std::max({0.0, by.dot(model), by.dot(between)}));
}

double SizeUncertainty::sd(Eigen::Index global) const {
  return std::sqrt(std::max({0.0, model_(global, global), between_clips_(global, global)}));
}

double SizeUncertainty::chi2(const std::vector<Eigen::Index>& globals, const Eigen::VectorXd& values) const {
  const Eigen::MatrixXd covariance = model_(globals, globals);
  return values.dot(base::solve_positive(covariance, values).col(0));
}

}  // namespace glidelab::diagnose
