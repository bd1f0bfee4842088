/// From a comparison of hypotheses to what is said: the verdict, its effects, where, how much, and in words.
#pragma once

#include "diagnose/diagnosis.h"
#include "diagnose/hypotheses.h"
#include "diagnose/picture_evidence.h"

namespace glidelab::diagnose {

Diagnosis verdict_of(const TrackSet& set, const Comparison& comparison, PictureEvidence pictures = {});

/// The best hypothesis that names something, or null.
const Hypothesis* best_named(const Comparison& comparison);

}  // namespace glidelab::diagnose
