#include "core/pictures/camera/pose_elimination.h"

#include "base/math/dense.h"

namespace glidelab::core {

TermUncertainty uncertainty_of_terms(const std::vector<ViewDerivatives>& views) {
  const Eigen::Index size = views.front().by_terms.cols();
  std::vector<ViewResiduals> residuals;
  std::vector<Eigen::MatrixXd> left;  // M
  for (const ViewDerivatives& one : views) {
    const Eigen::MatrixXd of_pose = base::transposed_product(one.view.by_pose, one.view.by_pose);
    const Eigen::MatrixXd taken_up =
        base::solve_positive(of_pose, base::transposed_product(one.view.by_pose, one.by_terms));
    left.push_back(one.by_terms - base::product(one.view.by_pose, taken_up));
    residuals.push_back(one.view);
  }
  TermUncertainty uncertainty;
  uncertainty.noise = estimate_corner_noise(residuals, static_cast<std::size_t>(size));
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size), scatter = information;
  for (std::size_t i = 0; i < views.size(); ++i) {
    information += base::transposed_product(left[i], left[i]);
    scatter += base::transposed_product(left[i], times_covariance(uncertainty.noise, residuals[i].grid, left[i]));
  }
  const Eigen::MatrixXd inverse = base::inverse_positive(information);
  uncertainty.covariance = base::product(base::product(inverse, scatter), inverse);
  return uncertainty;
}

}  // namespace glidelab::core
