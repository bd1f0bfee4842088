/// Whether the sizes of single clips follow something: a drift, or the configuration.
///
/// Where friction drifts from clip to clip and scatters a little as well, no drift alone follows the clips to within
/// their noise, while clips that each have their own friction do, and a remainder of each motion says less of a clip
/// than one friction for all its motions. The drift then has no chance against the scatter, however plain it is. So the
/// sizes of the clips that scatter are looked at: with s the fitted sizes and C their covariance, the prior
///
///     s ~ N(0, W_own),      W_own = diag(width²)
///
/// is compared with one in which they share a part,
///
///     s ~ N(0, W_own + w² u u'),        u_i = i - mean of i,                        for a drift of friction
///     s ~ N(0, W_own + w² Z Z'),        Z_ij = 1 if clip i has configuration j,     for one friction or drag for each
///
/// all widths being averaged over (spread_prior.h). The factor between the two is that by which the shared part
/// explains these clips better than sizes that are independent of each other.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnose/causes/remainder.h"
#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// The log of that factor for `effect`. `clips` is a fit with clip_scatter, linearised with the noise alone, and
/// `sizes` is its remainder. Empty for an effect that the sizes of clips do not follow (AmongClips), and if the fit has
/// not a size for each of three clips or more.
std::optional<double> gain_of_structure(const TrackSet& set, const MotionFit& clips, const RemainderSizes& sizes,
                                        std::size_t effect);

/// Whether such a part makes the sizes of a fit with clip_scatter by the noise alone likelier.
bool follows_structure(const TrackSet& set, const MotionFit& clips);

}  // namespace glidelab::diagnose
