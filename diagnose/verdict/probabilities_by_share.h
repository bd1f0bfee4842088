/// What the share of the gap that named causes take does to the probabilities of a comparison.
///
/// A verdict on a gap names causes that take half of its excess or more. Probabilities by evidence alone do not know
/// that: an explanation may be far likelier than all others and leave most of the gap, or take nearly all of it and be
/// less likely than a curve without a name, which any gap has where the noise is small. All functions keep the sum over
/// explanations, none and unknown at 1, and each effect's probability the sum over the explanations that have it.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/causes/cause_sequence.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

inline constexpr double kHalfOfGap = 0.5;           ///< of the excess: what a verdict's causes take at least
inline constexpr double kJustUnknown = 0.5 + 1e-9;  ///< the least probability of an unknown cause with such a verdict
inline constexpr double kMostOfGap = 0.75;  ///< of the excess: what a law takes that has its name by its share alone
inline constexpr double kByShare = 0.8;     ///< the probability of such a name

/// Whether some of an explanation's effects takes part of the gap.
bool shows_in_gap(const Hypothesis& explanation);

/// Whether a likelier cause alone may take the place of the named ones: it takes half of the gap itself, or they take
/// less as well. A name that explains the gap does not go for one that would make the cause unknown.
bool may_displace(const CauseSequence& likelier, const CauseSequence& named);

/// What these explanations would explain needs no cause.
void move_to_none(bool (*of)(const Hypothesis&), Comparison& comparison);

/// The rest is shared as before among what has a name, or nothing.
void set_unknown(double unknown, Comparison& comparison);

/// Explanations that leave more than half of the gap have no name to give: what acts is unknown if they are all there
/// is.
void move_minorities_to_unknown(Comparison& comparison);

/// Probabilities as a verdict on a gap above its floor. What the remainder makes is unknown; so is the cause where
/// `best`, the effects that would be named, take less than half after all.
///
/// Where the noise is next to nothing beside the gap (an excess of kLargestExcess or more) any curve has the evidence
/// of certainty, and only the share counts: a law common to all clips that takes kMostOfGap has its name with kByShare,
/// if the evidence has less for it. All explanations with this main cause share that as they did before, so that what
/// stands beside it keeps its own, and everything else shares the rest.
void hold_to_share(const CauseSequence& sequence, const std::vector<std::size_t>& best, Comparison& comparison);

}  // namespace glidelab::diagnose
