/// What it costs an explanation that it has many sizes of one kind: a friction of each clip, the bumps of a track.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace glidelab::diagnose {

/// Log prior density of sizes, averaged over what the data leave open of them. Sizes of one kind are drawn from one
/// normal distribution about 0 whose width is uniform in its logarithm over four decades, from twice the best known
/// combination's standard deviation on. With s the fitted sizes and C their joint covariance under flat priors,
///
///     log density = log N(s; 0, C + W) + n/2 log(2 pi),      W = diag(width²), the widths of each kind averaged over.
///
/// The covariance counts as a whole. A friction and a drag of one clip may each be all but open while a combination of
/// the two is known to a thousandth; by their variances alone they would cost a factor of a thousand for each clip that
/// no data can give back.
///
/// `kinds` has the kind of each size, from 0.
double log_spread_prior(const Eigen::VectorXd& sizes, const Eigen::MatrixXd& covariance,
                        const std::vector<std::size_t>& kinds);

}  // namespace glidelab::diagnose
