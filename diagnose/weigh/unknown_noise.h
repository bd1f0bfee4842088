/// Evidence where few positions show the noise.
///
/// The noise is estimated from how far positions lie off their neighbours. Of n positions its relative variance is
/// 4 * 1.32/n (gap/held_out.cpp), which is that of chi² with nu = 0.38 n degrees of freedom. With the variance drawn
/// from its posterior in place of its estimate, Gaussian residuals follow Student's t, and a model with chi² (in units
/// of the estimated noise) for n positions has
///
///     log L = -(nu + n)/2 log(1 + chi²/nu).
///
/// For many positions this is -chi²/2 about chi² = n. Of fifteen positions it takes most of the certainty from a gain.
#pragma once

#include <optional>

#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

struct FewPositions {
  double positions = 0.0, degrees = 0.0;  ///< n and nu
};

/// None if there are so many positions (nu of 30 or more) that the noise counts as known.
std::optional<FewPositions> few_positions(const TrackSet& set);

/// The gain in log likelihood with an unknown noise, of an explanation that gains `gain` with the estimated one over a
/// model with `chi2`.
double gain_with_unknown_noise(const FewPositions& of, double chi2, double gain);

/// What is to be taken off the log evidence of an explanation that gains `gain` with the estimated noise over a model
/// with `chi2`: 0 if the noise counts as known. A loss counts in full: it is that of the wrong drag in a fall.
double lost_to_unknown_noise(const std::optional<FewPositions>& of, double chi2, double gain);

}  // namespace glidelab::diagnose
