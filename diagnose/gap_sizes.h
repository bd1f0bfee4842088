/// The gap of an experiment before and after, with its intervals over clips, and what is left of the positions.
#pragma once

#include <string>
#include <vector>

#include "diagnose/diagnosis.h"
#include "diagnose/motion_fit.h"

namespace glidelab::diagnose {

/// Of clips held out (held_out.h), by the usual model's fit and by the best one's. A single clip is cut into stretches
/// that are fitted anew; a note says so.
GapSizes gap_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best, std::vector<std::string>& notes);

/// Of every motion some 250 residuals of either fit to all clips, in metres.
std::vector<ResidualCurve> residuals_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best);

}  // namespace glidelab::diagnose
