/// K/m, mu, alpha and the terminal velocity of each configuration, with the named causes in the model.
///
/// The parameters are those at the minimum of the fit's neighbourhood when the remainder counts as noise (remainder.h),
/// so that their intervals hold the truth beside imperfections that have no name. The terminal velocity is where the
/// force vanishes, m g sin(alpha) = drag(v) + friction(v) with all causes in it, in the middle of the set-up's track;
/// its standard deviation follows from the parameters' covariance by finite differences. Causes that act for a while
/// only (a hand, a shaking) are left out of it.
#pragma once

#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// `fit` is linearised in `set`, by the noise alone.
std::vector<RecoveredConfiguration> recovered_of(const TrackSet& set, const MotionFit& fit,
                                                 const RemainderSizes& sizes);

}  // namespace glidelab::diagnose
