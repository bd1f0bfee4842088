/// effect_scan: How well each effect on the list, or two together, would explain the residuals of a fit.
///
/// How well each effect on the list would explain the residuals of a fit, in the linear neighbourhood of that fit.
///
/// An amplitude is a score test; a second parameter is searched on a grid and its evidence averaged over it; a wave has
/// one amplitude and one frequency for all motions and a free phase in each (averaged over); sizes of one kind, such as
/// each clip's, are drawn from one normal distribution, whose width is averaged over; a push has a size in each
/// motion and one time; nine times in ten pushes go along the motions and are about alike, as one hand's are.
///
/// How well two effects together would explain the residuals of a fit, in the linear neighbourhood of that fit.
///
/// Each by itself may show little because the other hides it: two sizes that work against each other, or a first fit
/// that the second effect leads astray. Both are therefore fitted at once to what the nominal model leaves, for all
/// pairs and all second parameters that were tried.
#pragma once

#include <set>
#include <vector>

#include "diagnose/scan/timed_scan.h"

namespace glidelab::diagnose {

/// Values of the second parameter that are tried (one empty list for an effect without one).
std::vector<std::vector<double>> effect_shapes(const TrackSet& set, std::size_t effect);

/// Square of what is left of a column, over the noise; 0 where that is no more than its own rounding.
double seen_square(const ScoreSpace& space, const ScoreColumn& column);

/// Of an effect that acts through the trajectory (not Search::frames, Search::noise).
EffectScan scan_effect(const ScoreSpace& space, std::size_t effect);

/// All effects but those of `without` (which are not visible), in the order of effect_list(), `jobs` at a time.
std::vector<EffectScan> scan_effects(const ScoreSpace& space, const std::set<std::size_t>& without, int jobs);

struct PairScan {
  std::size_t first = 0, second = 0;  ///< effects
  double gain = 0.0;                  ///< log likelihood gained at the best sizes, linear estimate
  double log_evidence = 0.0;          ///< against the fit itself, sizes and second parameters averaged over
  std::vector<double> first_values, second_values;  ///< of the common parameters, where to begin a fit
};

/// Of the effects whose scans hold directions (an amplitude, perhaps with a second parameter), by falling evidence.
/// Pairs that these data cannot tell from one of the two are left out.
std::vector<PairScan> scan_pairs(const ScoreSpace& space, const std::vector<EffectScan>& scans);

}  // namespace glidelab::diagnose
