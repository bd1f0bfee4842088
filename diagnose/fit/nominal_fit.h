/// The fit of the nominal model: viscous drag, friction and gravity. It starts every diagnosis.
#pragma once

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// The nominal model, from the start given by the integrated positions (integrated_start.h); if that fits badly, also
/// from the stated inclinations with three rates of drag. Returns the best of these fits.
MotionFit fit_nominal(const TrackSet& set, const Lateness& late = {});

}  // namespace glidelab::diagnose
