/// The result of the search for one effect.
#pragma once

#include <cstddef>
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

}  // namespace glidelab::diagnose
