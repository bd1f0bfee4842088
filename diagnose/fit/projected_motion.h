/// A fit's linear neighbourhood with each motion's own parameters projected out: what is left are the common parameters
/// and their normal equations,
///
///     N = sum_i G_i' G_i + statements,    g = sum_i G_i' r_i + statements,    G_i, r_i = Q_i (derivatives, residuals),
///
/// in units of the noise, Q_i = 1 - A (A'A)^-1 A' of the motion's own derivatives A. A change of the common parameters
/// by N^-1 g is the least squares' step.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "base/math/dense.h"
#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// A motion's derivatives by its own parameters.
struct OwnColumns {
  Eigen::VectorXd scale;
  Eigen::MatrixXd scaled;
  Eigen::MatrixXd gain;  ///< sizes of the scaled columns from positions
};
OwnColumns own_columns(const FitMotion& motion);

/// Columns over a motion's points (of unit white noise) without what its own parameters can take up.
Eigen::MatrixXd without_own(const FitMotion& motion, const base::MatrixView& columns);

struct ProjectedMotion {
  Eigen::VectorXd residual;
  Eigen::MatrixXd common;
  double freedom = 0.0;  ///< points less own parameters
};
ProjectedMotion project(const FitMotion& motion);

struct CommonNormal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;

  void add(const ProjectedMotion& motion, double sign = 1.0);
};
/// Without the motions of one clip.
CommonNormal without_clip(const TrackSet& set, CommonNormal all, const std::vector<ProjectedMotion>& motions,
                          std::size_t clip);

/// Of what is stated alone.
CommonNormal statements_normal(const MotionFit& fit);

/// Inverse of a scaled, hardly held-back matrix: directions that nothing determines become very uncertain.
Eigen::MatrixXd inverse_normal(const Eigen::MatrixXd& matrix);

}  // namespace glidelab::diagnose
