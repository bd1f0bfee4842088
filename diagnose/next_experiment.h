/// Which further clips would tell most.
#pragma once

#include <string>

#include "diagnose/diagnosis.h"
#include "diagnose/hypotheses.h"

namespace glidelab::diagnose {

/// One sentence or two. Among feasible changes (another mass, launch, inclination, frame rate, a plumb line), the one
/// after which the two leading explanations would differ most in log likelihood (or the named effect be known best).
std::string next_experiment(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
