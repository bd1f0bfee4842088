/// The causes of a gap in the order in which a verdict tells them, and what they leave.
#pragma once

#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// With an unknown cause, the causes that help and together take less than half of the excess. A cause that would take
/// more is not likely enough to be named, so it is not said to explain anything. Neither is one beside which held-out
/// positions lie farther off than without it.
std::vector<ExplainedCause> helpful(std::vector<ExplainedCause> causes);

/// What the causes leave of a gap of this size. `part_s`: RemainderSpace::part_s().
GapRemainder remainder_of(double gap_before, const std::vector<ExplainedCause>& causes, const RemainderSizes& sizes,
                          double part_s);

/// Puts the effects that a verdict names in order of falling share, and then those that no motion shows. In a fall
/// through air the drag comes first: the other shares are what is left beside it. A cause that stated inclinations show
/// has no share, and comes first if it is likelier than any that has one.
void order_by_share(bool drag_first, Diagnosis& diagnosis);

/// Whether the diagnosis names all of these effects.
bool names_all(const Diagnosis& diagnosis, const std::vector<std::size_t>& effects);

}  // namespace glidelab::diagnose
