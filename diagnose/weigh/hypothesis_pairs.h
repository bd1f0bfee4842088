/// Explanations by two effects at once.
#pragma once

#include <set>

#include "diagnose/fit/score_space.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// Leading effects each with a second one; pairs that show only together (pair_scan.h); and in place of one of the best
/// pair's two, whatever shows better beside the other. `nominal` is the neighbourhood of the first fit.
void add_pairs(const TrackSet& set, const ScoreSpace& nominal, const std::set<std::size_t>& without, const Work& work,
               Comparison& comparison);

}  // namespace glidelab::diagnose
