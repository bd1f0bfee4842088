/// Which statements the data contradict, and which part of the data is set aside: limits that a reader must know before
/// the verdict.
///
/// Drag and friction take energy from a glider. A nominal fit that has them give some, by more than five standard
/// deviations, explains nothing, however well it follows the positions: "nothing is missing" is no verdict then, and
/// its probability belongs to what has no name.
#pragma once

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// Of the fit that the verdict rests on.
VerdictLimits limits_of(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
