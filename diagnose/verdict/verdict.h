/// From a comparison of hypotheses to the statements about it: the verdict, its effects, where the gap lies, and how
/// large it is.
#pragma once

#include "diagnose/pictures/picture_evidence.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

Diagnosis verdict_of(const TrackSet& set, const Comparison& comparison, PictureEvidence pictures = {});

}  // namespace glidelab::diagnose
