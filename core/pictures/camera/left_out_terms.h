/// What terms of a lens that its calibration left out may still do.
///
/// A term that the views do not determine is fixed to zero. It may still be real, and the fit without it then errs by
/// more than its own covariance. For a term v with covariance C in the last fit that had it, and C_a the covariance of
/// all terms with it, we add
///
///     b C_a C^-1 C_a' + r w w',    w = b C_a C^-1 v,    r = max(0, 1 - q / (b v' C^-1 v)):
///
/// the effect of its uncertainty, and the part of its value beyond noise (q numbers in v). b is how far the term is
/// believed: 1 for p1, p2; usual² / (usual² + s²) for a radial term, whose part s at the image's corner is N(0, usual²)
/// over lenses. A straight lens has small high terms: of k2 and k3, usual is at most `of_extent` times the lens's
/// extent e, the sum of the sizes at the corner of the radial terms that were kept and, where k1 was left out, of the
/// largest likely k1 (its size and two standard deviations). k1 itself defines the extent and is not bounded by it.
///
/// High terms go with k1 in lenses as they are. They do not in images that a camera has straightened itself, or in a
/// lens whose k1 happens to be near zero with large k2 and k3: there the intervals may be too narrow.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace glidelab::core {

struct LeftOutTerm {
  int power = 0;                        ///< of r², of a radial term; 0 for p1, p2
  double usual = 0.0, of_extent = 0.0;  ///< of a radial term; of_extent of k2 and k3 alone
  double at_corner = 0.0;               ///< relative displacement of the image's corner by a radial term of 1
  Eigen::VectorXd value;                ///< in the last fit that had it,
  Eigen::MatrixXd own, with_others;     ///< and its covariance, and that of all terms with it
};

/// usual² / (usual² + sd²)
double believed(double usual, double sd);

/// The covariance that they add. `kept_at_corner`: the sum of the sizes, at the corner, of the radial terms that were
/// kept.
Eigen::Matrix<double, 9, 9> effect_of(const std::vector<LeftOutTerm>& all, double kept_at_corner);

}  // namespace glidelab::core
