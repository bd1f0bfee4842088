/// Explanations weighed together with an unmodelled remainder, where the nominal model and the list of effects leave
/// more than the noise.
///
/// Real recordings have one or two main causes and several small imperfections. Measured against the noise alone,
/// anything left beside a named cause refutes it. Here each explanation, the nominal model too, has a remainder of its
/// own (remainder.h), and it earns its name by how far it makes that remainder shrink:
///
///     log evidence = max over the remainder's sizes of log L(positions; explanation, remainder)
///                    + log prior density of the effect's parameters at the fit
///
/// Sizes of effects and functions without a name are uniform in their logarithm over four decades, and so is the width
/// of the normal distribution that sizes of one kind are drawn from (of each clip, say); other parameters are uniform
/// over their ranges; the pushes of a hand that lets go late act along the motions and are about equal. The
/// explanations are those that the search of hypotheses.h finds when the remainder of the best one so far counts as
/// noise, and the likeliest by the noise alone. Functions without a name compete as before, with remainders of their
/// own. Probabilities follow from the evidence and from what each explanation leaves of the gap (cause_odds.h).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {

/// A fit of the comparison, linearised by the noise alone, and the remainder that suits it best.
struct WeighedFit {
  MotionFit noise_alone;
  RemainderSizes sizes;
};

struct WeighedCauses {
  TrackSet set;                                 ///< with the remainder of the likeliest explanation as noise
  Comparison comparison;                        ///< by that set
  std::vector<std::optional<WeighedFit>> fits;  ///< as comparison.fits; those that were weighed
};

/// `first` is the comparison by the noise alone; `set` has no remainder.
WeighedCauses weigh_causes(const TrackSet& set, const Comparison& first, const std::set<std::size_t>& without, int jobs,
                           const PictureEvidence* pictures, const std::function<void(double)>& done);

/// Repeats the comparison by the noise alone, each of its likeliest explanations with the remainder that suits it best:
/// for data without a gap, in which small imperfections still show.
void allow_for_remainders(const TrackSet& set, const std::set<std::size_t>& without, int jobs, Comparison& comparison);

}  // namespace glidelab::diagnose
