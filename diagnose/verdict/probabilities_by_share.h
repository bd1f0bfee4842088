/// How the share of the gap that named causes take changes the probabilities of a comparison.
///
/// A verdict on a gap names causes that take half of its excess or more. Probabilities by evidence alone ignore this:
/// an explanation may be far likelier than all others and yet leave most of the gap, or take nearly all of it and yet
/// be less likely than a curve without a name, which can follow any gap where the noise is small. All functions keep
/// the sum over explanations, none and unknown at 1, and the probability of each effect equal to the sum over the
/// explanations that contain it.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "diagnose/causes/cause_sequence.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

inline constexpr double kHalfOfGap = 0.5;  ///< of the excess: the least that a verdict's causes take together
inline constexpr double kUnknownIfLess = 0.5 + 1e-9;  ///< the least probability of an unknown cause if they take less
inline constexpr double kMostOfGap = 0.75;  ///< of the excess: the least by which a law is named by its share alone
inline constexpr double kProbabilityByShare = 0.8;  ///< the probability of a law that is named by its share

/// Whether a likelier cause alone may replace the named ones: it takes half of the gap itself, or they take less as
/// well. A name that explains the gap does not give way to one that would make the cause unknown.
bool may_displace(const CauseSequence& likelier, const CauseSequence& named);

/// Whether a name is known by stated inclinations alone, beside a gap that is less than the noise: it need not take
/// half of that.
bool needs_no_share(const CauseSequence& sequence, const Hypothesis& named, const Comparison& comparison);

/// Whether the first of the named causes may take nothing, by the 95 % interval of its share, of an excess that is less
/// than the noise. A larger gap of few clips keeps its names: its interval is wide because the clips differ.
bool may_take_nothing(const CauseSequence& sequence);

/// The probability that single positions scatter, and nothing else acts.
double probability_of_scatter(const Comparison& comparison);

/// Moves the probability of the explanations for which `of` holds to `none`: what they would explain needs no cause.
void move_to_none(const std::function<bool(const Hypothesis&)>& of, Comparison& comparison);

/// For a fall through air whose positions are rounded as finely as the nominal model follows them: nothing finer than
/// the step is claimed, and that something brakes in proportion to the square of the speed is known without them. The
/// nominal model and explanations with a quadratic drag share the probability of all others.
void keep_drag_of_air(Comparison& comparison);

/// Sets the probability of an unknown cause. Named explanations and `none` share the rest in proportion to their
/// probabilities.
void set_unknown(double unknown, Comparison& comparison);

/// Where no gap shows, a contradiction of stated inclinations is still neither noise nor a small imperfection. The
/// single effects that resolve it (gain_in_stated(), with no such contradiction left) then share what an unknown cause,
/// the wrong statement among them, leaves: 0.9. Whether there are any; nothing changes otherwise.
bool trust_stated(Comparison& comparison);

/// Moves the probability of explanations that leave more than half of the gap to `unknown`: they cannot name its cause.
/// What is known by stated inclinations keeps it.
void move_minorities_to_unknown(Comparison& comparison);

/// The probabilities for a verdict on a gap above the noise floor. A gap that the remainder alone explains has an
/// unknown cause. The same holds for a gap of which `best`, the effects to be named, takes less than half.
///
/// Where the noise is negligible beside the gap (an excess of kLargestExcess or more), any curve has the evidence of a
/// certainty, and only the share counts. A law common to all clips that takes kMostOfGap is then named with the
/// probability kProbabilityByShare, if the evidence gives it less. All explanations with this main cause share it in
/// proportion to their probabilities, and everything else shares the rest. `by_air`: the gap is measured from a fall
/// without drag.
void hold_to_share(const CauseSequence& sequence, const std::vector<std::size_t>& best, bool by_air,
                   Comparison& comparison);

}  // namespace glidelab::diagnose
