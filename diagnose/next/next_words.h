/// What to record next where no launch decides by its motion: a sentence with the physical reason.
#pragma once

#include <string>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// Of something without a name: the change that covers best the variable in which it lies (the first region).
/// `nominal` is the fit of the nominal model.
std::string next_for_unnamed(const TrackSet& set, const MotionFit& nominal, const Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
