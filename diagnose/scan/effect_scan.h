/// How well each effect of the list would explain what a fit leaves, in the linear neighbourhood of that fit.
///
/// An amplitude is a score test; a second parameter is searched on a grid and its evidence averaged over it; a wave has
/// one amplitude and one frequency for all motions and a free phase in each (averaged over); a push has a size in each
/// motion and one time; nine times in ten pushes go along the motions and are about alike, as one hand's are.
#pragma once

#include <set>
#include <vector>

#include "diagnose/fit/score_space.h"

namespace glidelab::diagnose {

/// One value of the second parameter that was tried (none of an effect without one).
struct TriedShape {
  std::vector<double> values;
  ScoreColumn column;                ///< what the first parameter changes,
  double square = 0.0, score = 0.0;  ///< what is left of it, squared, and its product with what the fit leaves
};

struct EffectScan {
  std::size_t effect = 0;
  bool visible = false;                  ///< the largest size allowed would show in these data
  double gain = 0.0;                     ///< log likelihood gained at the best, linear estimate
  double log_evidence = 0.0;             ///< against the fit itself, prior sizes averaged over
  double least_seen = 0.0;               ///< size of one standard deviation (of the first parameter)
  std::vector<double> values;            ///< of the parameters that are common, where to begin a fit
  std::vector<std::vector<double>> own;  ///< of each motion's own ones
  ScoreColumn direction;                 ///< what it changes, at its best shape
  std::vector<TriedShape> shapes;        ///< all that would show
};

/// Values of the second parameter that are tried (one empty list for an effect without one).
std::vector<std::vector<double>> effect_shapes(const TrackSet& set, std::size_t effect);

/// Square of what is left of a column, over the noise; 0 where that is no more than its own rounding.
double seen_square(const ScoreSpace& space, const ScoreColumn& column);

/// Of an effect that acts through the trajectory (not Search::frames, Search::noise).
EffectScan scan_effect(const ScoreSpace& space, std::size_t effect);

/// All effects but those of `without` (which are not visible), in the order of effect_list(), `jobs` at a time.
std::vector<EffectScan> scan_effects(const ScoreSpace& space, const std::set<std::size_t>& without, int jobs);

}  // namespace glidelab::diagnose
