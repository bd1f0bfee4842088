/// Which further recording or measurement would tell most.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"
#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {

/// One sentence or two. Of the feasible changes (next_changes.h) the one that is expected to split the leading
/// explanation best from its rivals (expected_evidence.h), up to three: those that are equivalent to it or have a
/// twentieth of the probability or more; it is the change after which their odds together fall most. Without a rival,
/// the one after which the weakest parameter (largest standard deviation over its size; of the named effects, or else
/// of K and mu) would be known best. What only pictures or single frames show, and what has no name, have sentences of
/// their own (next_words.h).
std::string next_experiment(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
