/// A search that stopped at a poor minimum starts again from the fit of the effect's mirror (effects/effect.h), which
/// moves the body or its image in the same way.
///
/// A cable that tightens beyond some place is a bumper at the downhill end, and a camera that sways is a table that
/// shakes, since the start of each motion takes up what else their displacements have:
///
///     -(a/w²) sin(w t + phase)  of the table    and    A sin(w t + phase)  of the camera,      w = 2 pi f
///
/// Searches for the two start at different points, and one of them may end at a poor minimum. Which of the names then
/// stands would depend on that, and not on the data.
#pragma once

#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// The likeliest fits with one of such effects, fitted again with its twin in its place, where that has no fit or a
/// worse one. A cable and a bumper with equally good fits then count as one cause (Comparison::alike). `left_out` are
/// effects that are not considered.
void add_twins(const TrackSet& set, const std::set<std::size_t>& left_out, const Work& work, Comparison& comparison);

}  // namespace glidelab::diagnose
