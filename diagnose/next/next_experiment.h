/// Which further recording or measurement would be most informative, whether the cause has a name or not.
#pragma once

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// What to record next if something without a name acts: the change that best covers the variable in which it lies (the
/// first region). `nominal` is the fit of the nominal model.
NextStep next_for_unnamed(const TrackSet& set, const MotionFit& nominal, const Diagnosis& diagnosis);

/// Of the feasible changes (next_changes.h), the one that is expected to tell the leading explanation best from its
/// rivals (expected_evidence.h). Up to three rivals count: those that are equivalent to it or have a twentieth of the
/// probability or more. The best change is the one that lowers their joint odds most. Without a rival, it is the change
/// after which the weakest parameter (largest standard deviation over its size; of the named effects, or else of K and
/// mu) would be known best; the same holds if each rival only adds something that no change would decide. Effects that
/// only images or single frames show (their own step, effect.h) and effects without a name (next_for_unnamed()) have
/// their own steps. `diagnosis` is complete except for its next step.
NextStep next_experiment(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
