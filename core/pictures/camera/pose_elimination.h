/// The uncertainty of a camera's terms that were fitted together with the poses of its views.
///
/// With the poses eliminated, M = J - P (P'P)^-1 P'J of every view, an error e of the corners changes the camera's
/// terms by S^-1 sum of M'e, S = sum of M'M; so their covariance is S^-1 [sum of M'V M] S^-1, V that of corner_noise.h.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/pictures/board/corner_noise.h"

namespace glidelab::core {

/// Of one view: its residuals and their derivatives by its pose, and those by the camera's free terms.
struct ViewDerivatives {
  ViewResiduals view;
  Eigen::MatrixXd by_terms;
};

struct TermUncertainty {
  Eigen::MatrixXd covariance;  ///< of the free terms
  CornerNoise noise;
};

/// At least one view; all with derivatives by the same terms.
TermUncertainty uncertainty_of_terms(const std::vector<ViewDerivatives>& views);

}  // namespace glidelab::core
