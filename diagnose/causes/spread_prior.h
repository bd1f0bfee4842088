/// The cost of many sizes of one kind in an explanation: a friction of each clip, the bumps of a track.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>
#include "diagnose/causes/remainder.h"
#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

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
double log_spread_prior(const Eigen::VectorXd& sizes, const Eigen::MatrixXd& covariance,
                        const std::vector<std::size_t>& kinds);

/// Clips that scatter, in addition to a law that all clips have in common.
///
/// The search for pairs (weigh/hypothesis_pairs.h) leaves out effects that differ from clip to clip. Beside a wrong law
/// they absorb whatever that law leaves, and a remainder that scatters from clip to clip hides them. If a law is
/// missing and friction scatters as well, neither name alone is then enough. The likeliest laws are therefore fitted
/// once more together with clips that scatter, by the noise alone, and these pairs are weighed like every other
/// explanation.
///
/// The fit of `law` together with clip_scatter, by the noise of `set` alone. Empty if these clips cannot show it, or if
/// the fit fails.
std::optional<MotionFit> with_clip_scatter(const TrackSet& set, const MotionFit& law);

/// The laws that show best beside clips that scatter, whose fit is `scatter` and whose remainder is `sizes`, each
/// fitted together with them by the noise alone. A law that takes less than the scatter does hardly shows by itself, so
/// the likeliest laws by themselves may be others. `without` are indices of effects that are left out.
std::vector<MotionFit> laws_beside_scatter(const TrackSet& set, const MotionFit& scatter, const RemainderSizes& sizes,
                                           const std::set<std::size_t>& without);

}  // namespace glidelab::diagnose
