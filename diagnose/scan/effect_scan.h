/// How well each effect on the list, or two together, would explain the residuals of a fit, in the linear neighbourhood
/// of that fit.
#pragma once

#include <set>
#include <vector>

#include "diagnose/scan/timed_scan.h"

namespace glidelab::diagnose {

/// Values of the second parameter that are tried (one empty list for an effect without one).
std::vector<std::vector<double>> effect_shapes(const TrackSet& set, std::size_t effect);

/// Square of what is left of a column, over the noise; 0 where that is no more than its own rounding.
double seen_square(const ScoreSpace& space, const ScoreColumn& column);

/// Of an effect against another, before the data (EffectInfo::odds); 0: this recording cannot show it.
double prior_odds(const TrackSet& set, std::size_t effect);

/// Of an effect that acts through the trajectory (not Search::frames, Search::noise).
///
/// An amplitude is a score test. A second parameter is searched on a grid and its evidence averaged over it. A wave has
/// one amplitude and one frequency for all motions and a free phase in each (averaged over). Sizes of one kind, such as
/// each clip's, are drawn from one normal distribution, whose width is averaged over. A push has a size in each motion
/// and one time (timed_scan.h).
EffectScan scan_effect(const ScoreSpace& space, std::size_t effect);

/// All effects but those of `without` (which are not visible), in the order of effect_list(), `jobs` at a time.
std::vector<EffectScan> scan_effects(const ScoreSpace& space, const std::set<std::size_t>& without, int jobs);

struct PairScan {
  std::size_t first = 0, second = 0;  ///< effects
  double gain = 0.0;                  ///< log likelihood gained at the best sizes, linear estimate
  double log_evidence = 0.0;          ///< against the fit itself, sizes and second parameters averaged over
  std::vector<double> first_values, second_values;  ///< of the common parameters, where to begin a fit
};

/// Two effects together, of those whose scans hold directions (an amplitude, perhaps with a second parameter), by
/// falling evidence. Each by itself may show little because the other hides it: two sizes that work against each other,
/// or a first fit that the second effect leads astray. Both are therefore fitted together to the residuals of the
/// nominal model, for all pairs and all second parameters that were tried. Pairs that these data cannot tell from one
/// of the two are left out.
std::vector<PairScan> scan_pairs(const ScoreSpace& space, const std::vector<EffectScan>& scans);

}  // namespace glidelab::diagnose
