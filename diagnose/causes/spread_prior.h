/// The cost of many sizes of one kind in an explanation: a friction of each clip, the bumps of a track.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace glidelab::diagnose {

/// A part that sizes of one kind have in common.
struct SharedPart {
  std::size_t kind = 0;
  Eigen::MatrixXd shape;  ///< over all sizes; 0 for those of other kinds
};

/// Log prior density of sizes, averaged over what the data leave open. Sizes of one kind are drawn from one normal
/// distribution about 0. Its width is uniform in its logarithm over four decades, which begin at twice the standard
/// deviation of the best known combination. With s the fitted sizes and C their joint covariance under flat priors,
///
///     log density = log N(s; 0, C + W) + n/2 log(2 pi),      W = diag(width²), the widths of each kind averaged over.
///
/// The full covariance counts. The friction and the drag of one clip may each be all but undetermined while a
/// combination of the two is known to a thousandth. By their variances alone they would cost a factor of a thousand for
/// each clip, which no data could make up for.
///
/// The widths of each kind are averaged over with those of the other kinds at their best. `kinds` has the kind of each
/// size, counted from 0.
///
/// With `shared`, sizes of one kind have a part in common: W also has width² times its shape, and this width is
/// averaged over like the others.
double log_spread_prior(const Eigen::VectorXd& sizes, const Eigen::MatrixXd& covariance,
                        const std::vector<std::size_t>& kinds, const SharedPart* shared = nullptr);

}  // namespace glidelab::diagnose
