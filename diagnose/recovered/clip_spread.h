/// How far clips differ in a parameter that each has of its own, from the values of one fit.
///
/// A fit gives n values d with covariance C, under the prior N(0, s²) of each. What the data alone say is their
/// information J = C⁻¹ - 1/s², about y with J y = C⁻¹ d. In the directions u_k of J, with eigenvalues l_k, the variance
/// V between clips solves (Paule and Mandel, J. Res. Natl. Bur. Stand. 87, 377, 1982)
///
///     Q(V) = sum over k of (u_k'y - m u_k'1)² / (1/l_k + V) = degrees of freedom
///
/// with m the weighted mean. A direction that the data leave open, such as a friction of each direction of motion where
/// the inclination is not known, has next to no weight. With the plain sum of squares it would decide.
#pragma once

#include <Eigen/Core>

namespace glidelab::diagnose {

struct ClipSpread {
  double variance = 0.0;
  double most = 0.0;  ///< an upper limit of the variance, exceeded with 10 %; the prior's if the data say nothing
};

ClipSpread clip_spread(const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance, double prior_sd);

}  // namespace glidelab::diagnose
