/// The linear neighbourhood of a fit: what remains of the motions, and of additions to the model, once all fitted
/// parameters have readjusted.
///
/// Each motion's own parameters are projected out. What remains are the common parameters and their normal equations,
///
///     N = sum_i G_i' G_i + statements,    g = sum_i G_i' r_i + statements,    G_i, r_i = Q_i (derivatives, residuals),
///
/// in units of the noise, with Q_i = 1 - A (A'A)^-1 A' of the motion's own derivatives A. A change of the common
/// parameters by N^-1 g is the least-squares step.
///
/// A small addition changes the model by c. With r the residuals, both divided by the noise, and J the derivatives with
/// respect to the fitted parameters,
///
///     <a, b> = a'b - a'J (J'J + statements)^-1 J'b,
///     gain in log likelihood of c at its best size = <c, r>² / (2 <c, c>).
///
/// This is Rao's score test with the nuisance projected out. It is linear in the addition.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "base/math/dense.h"
#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// A motion's derivatives with respect to its own parameters.
struct OwnColumns {
  Eigen::VectorXd scale;
  Eigen::MatrixXd scaled;
  Eigen::MatrixXd gain;  ///< maps positions to the sizes of the scaled columns
};
OwnColumns own_columns(const FitMotion& motion);

/// Columns over a motion's points (of unit white noise) minus the part that its own parameters can absorb.
Eigen::MatrixXd without_own(const FitMotion& motion, const base::MatrixView& columns);

/// A motion's r_i and G_i.
struct ProjectedMotion {
  Eigen::VectorXd residual;
  Eigen::MatrixXd common;
  double freedom = 0.0;  ///< number of points less number of own parameters
};
ProjectedMotion project(const FitMotion& motion);

/// N and g of the common parameters.
struct CommonNormal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;

  void add(const ProjectedMotion& motion);
  void add(const CommonNormal& others);
};
/// The normal equations of the statements and of all clips but one, for each clip. They are summed without that clip:
/// if it alone determines a parameter, as the only one that reaches a bumper does, a difference of sums would leave
/// rounding errors in place of nothing.
std::vector<CommonNormal> without_each_clip(const TrackSet& set, const CommonNormal& stated,
                                            const std::vector<ProjectedMotion>& motions);

/// The normal equations of the statements alone.
CommonNormal statements_normal(const MotionFit& fit);

/// Inverse of a scaled, slightly regularised matrix: directions that nothing determines become very uncertain.
Eigen::MatrixXd inverse_normal(const Eigen::MatrixXd& matrix);

/// A change of all positions divided by the noise, with each motion's own parameters projected out.
struct ScoreColumn {
  Eigen::VectorXd rest;    ///< all motions, concatenated
  Eigen::VectorXd common;  ///< its products with the whitened common parameters
};

/// Scalar products of columns with each other and with the residuals of a fit.
struct SpreadSeen {
  Eigen::MatrixXd products;
  Eigen::VectorXd scores;
};

/// What a small addition to a fitted model would gain once all fitted parameters have readjusted.
class ScoreSpace {
 public:
  ScoreSpace(const TrackSet& set, const MotionFit& fit);

  /// `by_motion` has one vector for each motion: the change of its modelled positions in metres.
  ScoreColumn project(const std::vector<Eigen::VectorXd>& by_motion) const;
  /// Change of the modelled positions of each motion, in metres per newton, due to an additional force, which each
  /// motion has its own (empty functions: none); by a forward difference of `size_n` (N).
  std::vector<Eigen::VectorXd> changes_by(const std::vector<UnnamedForce>& forces, double size_n) const;
  ScoreColumn of_force(const std::vector<UnnamedForce>& forces, double size_n) const;
  /// The change due to the first parameter of an effect whose other parameters have these values.
  ScoreColumn of_effect(std::size_t effect, const std::vector<double>& shape) const;
  /// The change due to one motion's own size of an effect, another parameter of which has this value.
  ScoreColumn of_own(std::size_t motion, EffectSlot size, double step, EffectSlot shape, double shape_value) const;

  /// The change due to one of the common parameters of an effect that the fit lacks, in a layout that has it.
  ScoreColumn of_parameter(const ParameterLayout::Global& global) const;
  /// All <c_i, c_j>, and all <c_i, r>.
  SpreadSeen seen(const std::vector<ScoreColumn>& columns) const;

  double dot(const ScoreColumn& a, const ScoreColumn& b) const;
  const ScoreColumn& residual() const { return residual_; }
  const MotionFit& fit() const { return fit_; }
  const TrackSet& set() const { return set_; }
  /// Positions of a motion according to the fit, and so without the noise that is in the residuals.
  const std::vector<double>& modelled(std::size_t motion) const { return base_[motion]; }
  /// The part of a change of a motion that its own parameters cannot absorb, divided by the noise.
  Eigen::VectorXd own_rest(std::size_t motion, const Eigen::VectorXd& change_m) const;
  Eigen::Index offset(std::size_t motion) const { return offset_[motion]; }

 private:
  Moved moved_by(std::size_t motion, const TrackModel& model) const;

  const TrackSet& set_;
  const MotionFit& fit_;
  std::vector<Eigen::MatrixXd> own_;       ///< orthonormal columns, for each motion
  Eigen::MatrixXd common_;                 ///< all points x common, own parameters projected out, whitened
  std::vector<std::vector<double>> base_;  ///< modelled positions
  std::vector<Eigen::Index> offset_;
  Eigen::Index points_ = 0;
  ScoreColumn residual_;
};

/// Log evidence for an amplitude against its absence. The likelihood is that of a measured size z_hat (in standard
/// deviations). The prior is uniform in log z from 2 (anything less cannot be told from nothing) to z_most, over both
/// signs or one.
double log_amplitude_evidence(double z_hat, double z_most, bool both_signs);

/// The same for many sizes at once, each N(0, tau²), with a prior uniform in log tau; `products` are <c_i, c_j>,
/// `scores` <c_i, r>. Products or scores that are not finite (a motion that runs off) say nothing: there is no mean.
struct SpreadEvidence {
  double log_evidence = 0.0;
  double gain = 0.0;           ///< log likelihood gained at the best tau
  double free_gain = 0.0;      ///< with free sizes (tau infinite)
  double tau = 0.0;            ///< best value
  Eigen::VectorXd mean;        ///< sizes at the best tau
  Eigen::MatrixXd covariance;  ///< of these sizes
};
SpreadEvidence log_spread_evidence(const Eigen::MatrixXd& products, const Eigen::VectorXd& scores);

}  // namespace glidelab::diagnose
