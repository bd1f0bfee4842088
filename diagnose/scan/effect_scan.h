/// How well each effect on the list would explain the residuals of a fit, in the linear neighbourhood of that fit.
///
/// An amplitude is a score test; a second parameter is searched on a grid and its evidence averaged over it; a wave has
/// one amplitude and one frequency for all motions and a free phase in each (averaged over); a push has a size in each
/// motion and one time; nine times in ten pushes go along the motions and are about alike, as one hand's are.
#pragma once

#include <set>
#include <vector>

#include "diagnose/scan/scanned_effect.h"

namespace glidelab::diagnose {

/// Values of the second parameter that are tried (one empty list for an effect without one).
std::vector<std::vector<double>> effect_shapes(const TrackSet& set, std::size_t effect);

/// Square of what is left of a column, over the noise; 0 where that is no more than its own rounding.
double seen_square(const ScoreSpace& space, const ScoreColumn& column);

/// Of an effect that acts through the trajectory (not Search::frames, Search::noise).
EffectScan scan_effect(const ScoreSpace& space, std::size_t effect);

/// All effects but those of `without` (which are not visible), in the order of effect_list(), `jobs` at a time.
std::vector<EffectScan> scan_effects(const ScoreSpace& space, const std::set<std::size_t>& without, int jobs);

}  // namespace glidelab::diagnose
