/// How well each effect on the list, or two together, would explain the residuals of a fit, in the linear neighbourhood
/// of that fit.
#pragma once

#include <set>
#include <vector>

#include "diagnose/scan/timed_scan.h"

namespace glidelab::diagnose {

/// The values of the second parameter that are tried; one empty list for an effect without a second parameter.
std::vector<std::vector<double>> effect_shapes(const TrackSet& set, std::size_t effect);

/// The square of a column's remaining part, in units of the noise; 0 if that part is no more than rounding.
double seen_square(const ScoreSpace& space, const ScoreColumn& column);

/// Prior odds of an effect relative to another (EffectInfo::odds); 0 if this recording cannot show it.
double prior_odds(const TrackSet& set, std::size_t effect);

/// The scan of one effect. An effect that does not act through the trajectory (Search::frames, noise, images, lines)
/// is not visible here.
///
/// An amplitude is a score test. A second parameter is searched on a grid, and the evidence is averaged over that grid.
/// A wave has one amplitude and one frequency for all motions and a free phase in each; the evidence is averaged over
/// all three. Sizes of one kind, such as one for each clip, are drawn from one normal distribution, and the evidence is
/// averaged over its width. A push has a size in each motion and one time for all (timed_scan.h).
EffectScan scan_effect(const ScoreSpace& space, std::size_t effect);

/// Scans of all effects in the order of effect_list(), `jobs` at a time. Those in `without` are not visible.
std::vector<EffectScan> scan_effects(const ScoreSpace& space, const std::set<std::size_t>& without, int jobs);

struct PairScan {
  std::size_t first = 0, second = 0;  ///< effects
  double gain = 0.0;                  ///< gain in log likelihood at the best sizes, by the linear estimate
  double log_evidence = 0.0;          ///< relative to the fit itself, averaged over sizes and second parameters
  std::vector<double> first_values, second_values;  ///< of the common parameters, from which to start a fit
};

/// Pairs of those effects whose scans have directions (an amplitude, perhaps with a second parameter), by falling
/// evidence. Each effect alone may show little because the other one hides it: two sizes that work against each other,
/// or a first fit that the second effect leads astray. Both are therefore fitted together to the residuals of the
/// nominal model, for all pairs and all second parameters that were tried. Pairs that these data cannot tell from one
/// effect of the two are left out.
std::vector<PairScan> scan_pairs(const ScoreSpace& space, const std::vector<EffectScan>& scans);

}  // namespace glidelab::diagnose
