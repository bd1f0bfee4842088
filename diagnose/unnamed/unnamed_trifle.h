/// Whether something without a name matters.
#pragma once

#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/unnamed/unnamed.h"

namespace glidelab::diagnose {

/// Whether the likeliest function without a name, put into the nominal model, moves neither K nor mu nor an inclination
/// by more than its standard deviation, and takes no more than four tenths of the noise (rms). Where there is no gap,
/// the function is a displacement or a force far below what could spoil a result, however certain it is. False if there
/// is none: nothing is known of it.
bool is_trifle(const TrackSet& set, const MotionFit& nominal, const std::vector<UnnamedFamily>& families);

}  // namespace glidelab::diagnose
