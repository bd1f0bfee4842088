/// The prior density of the parameters of an explanation that is weighed beside a remainder.
///
/// Sizes are uniform in their logarithm over four decades. Sizes of one kind (bumps along the track, the values of
/// clips or configurations) are drawn from one distribution (spread_prior.h), and so are the pushes of one hand. Shapes
/// are uniform over their range, and phases over a period.
#pragma once

#include "diagnose/causes/remainder.h"

namespace glidelab::diagnose {

/// Log prior density of the effects of a fit at its parameters, times sqrt(2 pi) for each parameter, which the
/// likelihood leaves out. In a fall through air models differ in which drag they have, so K has a prior as well: that
/// of the size of an effect, or Stokes' law where it is held.
double log_prior(const TrackSet& set, const MotionFit& fit, const RemainderSpace::Solution& solution);

}  // namespace glidelab::diagnose
