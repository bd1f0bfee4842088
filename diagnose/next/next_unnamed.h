/// What to record next if something without a name acts.
#pragma once

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// The change that best covers the variable in which it lies (the first region). `nominal` is the fit of the nominal
/// model.
NextStep next_for_unnamed(const TrackSet& set, const MotionFit& nominal, const Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
