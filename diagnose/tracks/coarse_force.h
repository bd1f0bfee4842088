/// A recorded force with no more samples than its motion can resolve.
///
/// A motor's force comes at some thousand samples a second, each of which costs the integration a step. Means over k
/// samples, weighted with a triangle of that half-width, preserve its integral and any straight line; what they smooth
/// away moves the positions by
///
///     d(t) = integral of integral of (F - F_k)/m,     up to a straight line, which the start x0, v0 absorbs.
#pragma once

#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

/// Takes for each motion's known force the coarsest of a few means whose |d| stays below `within_m` everywhere.
void coarsen_force(TrackedMotion& motion, double mass_kg, double within_m);

}  // namespace glidelab::diagnose
