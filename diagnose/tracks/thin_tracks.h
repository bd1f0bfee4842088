/// Parts of motions, and thinned motions.
#pragma once

#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

/// Points from, from + every, ... before `to` of a motion; without its whitening.
TrackedMotion some_points(const TrackedMotion& motion, std::size_t from, std::size_t to, std::size_t every = 1);

/// Of more than 30,000 positions in all (but for motions with a recorded force: driven_motions.h) every second, third,
/// ... is kept, with a note: enough for any law. What single frames show needs neighbours, and is weaker then. Motions
/// that have fewer than `fewest` left go.
void thin_out(TrackSet& set, std::size_t fewest);

}  // namespace glidelab::diagnose
