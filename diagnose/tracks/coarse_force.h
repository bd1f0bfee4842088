/// A recorded force at no more samples than its motion can tell.
///
/// A motor's force comes at some thousand samples a second, each of which costs the integration a step. Means over k
/// samples, weighted with a triangle of that half-width, keep its integral and any straight line; what they leave out
/// moves the positions by
///
///     d(t) = integral of integral of (F - F_k)/m,     but for a straight line, which the start x0, v0 takes up.
#pragma once

#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

/// Takes for each motion's known force the coarsest of a few means whose |d| stays below `within_m` everywhere.
void coarsen_force(TrackedMotion& motion, double mass_kg, double within_m);

}  // namespace glidelab::diagnose
