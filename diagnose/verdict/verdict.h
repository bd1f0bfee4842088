/// From a comparison of hypotheses to what is said: the verdict, its effects, where, how much, and in words.
#pragma once

#include "diagnose/pictures/picture_evidence.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {

Diagnosis verdict_of(const TrackSet& set, const Comparison& comparison, PictureEvidence pictures = {});

/// The likeliest hypothesis that names something, or null; causes that no experiment of tracks tells apart count
/// together (first_alike()), so that two names for one cause are not beaten by a less likely one with a single name.
const Hypothesis* best_named(const TrackSet& set, const Comparison& comparison);

}  // namespace glidelab::diagnose
