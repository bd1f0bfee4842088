/// Explanations by two causes at once: two effects, or missing frames beside an effect.
#pragma once

#include <set>

#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// Adds leading effects, each with a second one; pairs that show only together (effect_scan.h); and, in place of one
/// effect of the best pair, whatever shows better beside the other. `nominal` is the neighbourhood of the first fit.
void add_pairs(const TrackSet& set, const ScoreSpace& nominal, const std::set<std::size_t>& without, const Work& work,
               Comparison& comparison);

/// Looks for missing frames along the fits of the likeliest effects, alone or beside the known losses, and adds what it
/// finds to the comparison. Nothing is done if no frame is obviously missing. `nominal` is the nominal fit.
///
/// Beside a force or a displacement that the nominal model lacks, losses that no jump shows by itself do not count
/// (missing_frames.h), because any curve looks like a series of losses. With that effect in the fit they count.
void add_losses_beside(const TrackSet& set, const MotionFit& nominal, const std::set<std::size_t>& without,
                       const Work& work, Comparison& comparison);

}  // namespace glidelab::diagnose
