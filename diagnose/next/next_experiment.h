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
/// rivals (expected_evidence.h). The leading explanation is that by the effects which the verdict names. A rival has an
/// effect in place of one of these, or besides; its probability is that of all explanations of this kind. Up to three
/// rivals count: those that are equivalent or have a twentieth of the probability or more. The best change is the one
/// that lowers their joint odds most. Without a rival, it is the change after which the weakest parameter (largest
/// standard deviation over its size; of the named effects, or else of K and mu where they are not held at 0) would be
/// known best; the same holds if each rival only adds something that no change would decide. Effects that
/// only images or single frames show (their own step, effect.h) and effects without a name (next_for_unnamed()) have
/// their own steps. `diagnosis` is complete except for its next step.
NextStep next_experiment(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis);

/// Gives the weakest parameter of the next step as the tables of the diagnosis do: with the size of its effect, or as
/// recovered. The standard deviation that is expected after the change is scaled alike.
void quote_tables(Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
