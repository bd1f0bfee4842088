/// Weighs explanations together with an unmodelled remainder, where the nominal model and the effects on the list leave
/// more than the noise.
///
/// Real recordings have one or two main causes and several small imperfections. Measured against the noise alone,
/// whatever is left beside a named cause refutes it. Here each explanation, including the nominal model, has a
/// remainder of its own (remainder.h), and a cause earns its name by how much it makes that remainder shrink:
///
///     log evidence = max over the remainder's sizes of log L(positions; explanation, remainder)
///                    + log prior density of the effect's parameters at the fit
///
/// The likelihood is that of the linear neighbourhood of a fit, so each explanation that is weighed is fitted again
/// beside its own remainder, up to three times, until its log evidence changes by less than 0.5.
///
/// Priors: the sizes of effects and of functions without a name are uniform in their logarithm over four decades. So is
/// the width of the normal distribution from which sizes of one kind are drawn, such as one for each clip. Other
/// parameters are uniform over their ranges. The pushes of a hand that lets go late act along the motions and are about
/// equal. The explanations are those that the search of hypotheses.h finds when the remainder of the best explanation
/// so far counts as noise, and the likeliest ones by the noise alone. Functions without a name compete with them, with
/// remainders of their own. Probabilities follow from the evidence and from what each explanation leaves of the gap
/// (cause_odds.h).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {

/// A fit of the comparison, linearised with the noise alone, and its likeliest remainder.
struct WeighedFit {
  MotionFit noise_alone;
  RemainderSizes sizes;
};

struct WeighedCauses {
  TrackSet set;                                 ///< with the remainder of the likeliest explanation as noise
  Comparison comparison;                        ///< of explanations of that set
  std::vector<std::optional<WeighedFit>> fits;  ///< of each of comparison.fits; empty if it was not weighed
};

/// `first` is the comparison by the noise alone. `set` has no remainder. `without` are indices of effects that are left
/// out.
WeighedCauses weigh_causes(const TrackSet& set, const Comparison& first, const std::set<std::size_t>& without, int jobs,
                           const ImageEvidence* images, const std::function<void(double)>& done);

/// Weighs the comparison by the noise alone again, with the likeliest remainder for each of its likeliest explanations:
/// for data without a gap, in which small imperfections still show.
void allow_for_remainders(const TrackSet& set, const std::set<std::size_t>& without, int jobs, Comparison& comparison);

}  // namespace glidelab::diagnose
