/// How well two effects together would explain the residuals of a fit, in the linear neighbourhood of that fit.
///
/// Each by itself may show little because the other hides it: two sizes that work against each other, or a first fit
/// that the second effect leads astray. Both are therefore fitted at once to what the nominal model leaves, for all
/// pairs and all second parameters that were tried.
#pragma once

#include <vector>

#include "diagnose/scan/effect_scan.h"

namespace glidelab::diagnose {

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
