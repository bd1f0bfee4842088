/// position_rounding: Positions that are whole multiples of a step, as a motion sensor's or a spreadsheet's export has
/// them.
///
/// Differences x_i - x_0 = n_i s with whole n_i, to a thousandth of s: what a text of eight digits and its conversion
/// of units add is less. The step is the largest that all differences are multiples of.
#pragma once

#include <optional>

#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

/// Nothing where positions are no multiples of one step, where the step is less than a third of their noise (sd_m), or
/// where they have fewer than six different values, which could be so by chance.
std::optional<double> rounding_step_m(const TrackedMotion& motion);

/// The largest step of all motions, where each of them has one; else nothing.
std::optional<double> rounding_step_m(const TrackSet& set);

}  // namespace glidelab::diagnose
