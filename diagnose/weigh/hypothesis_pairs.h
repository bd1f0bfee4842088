/// Explanations by two effects at once.
#pragma once

#include <set>

#include "diagnose/fit/score_space.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// Pairs by their leaders; those that show together only (pair_scan.h); and, the best pair's two leading in turn,
/// whatever is better beside one of them. `nominal` is the neighbourhood of the first fit.
void add_pairs(const TrackSet& set, const ScoreSpace& nominal, const std::set<std::size_t>& without, const Work& work,
               Comparison& comparison);

}  // namespace glidelab::diagnose
