/// Which explanations of a comparison are weighed once more with something beside them.
#pragma once

#include <vector>

#include "diagnose/causes/cause_odds.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// The hypothesis that consists of the effects of a fit and nothing else; null if there is none.
const Hypothesis* pure_of(const Comparison& comparison, int fit);

/// Explanations by the noise alone: the best gives the first remainder, and all are weighed beside it.
inline constexpr std::size_t kMostByNoise = 6;
/// Explanations that get a remainder of their own.
inline constexpr std::size_t kMostProfiled = 14;

/// Indices of the likeliest fits by the noise alone, at most kMostByNoise, the nominal one first.
std::vector<std::size_t> likeliest_fits(const Comparison& by_noise);

/// Indices of the fits that are weighed anew: the nominal fit, all single effects and the likeliest pairs.
std::vector<std::size_t> worth_profiling(const TrackSet& set, const Comparison& comparison);

/// The explanations beside which a function without a name is weighed: the nominal model, the two single effects and
/// the pair with the most evidence, and those that are nearly as likely as the likeliest. Of two explanations that do
/// equally well, both must get the evidence of such a function, or the other falls behind. Scatter of single positions
/// makes no gap, so a function beside it would only repeat the one beside the nominal model.
std::vector<Hypothesis> worth_a_function(const Comparison& comparison, const LeftExcess& excess);

/// Explanations by what moves the glider or how it is seen, by falling probability, with what each leaves.
std::vector<Hypothesis> likeliest_laws(const Comparison& comparison, const LeftExcess& excess);

/// The likeliest laws that all clips have in common, or a hand, which acts at the start alone, that leave much of the
/// excess.
std::vector<Hypothesis> laws_that_leave_much(const Comparison& comparison, const LeftExcess& excess);

}  // namespace glidelab::diagnose
