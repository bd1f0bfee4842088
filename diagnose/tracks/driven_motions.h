/// Motions that a recorded force drives to and fro, in pieces.
///
/// What the model lacks in force adds up twice over the time, and a turn that comes a little early starts the next run
/// elsewhere: over tens of turns chi² has a local minimum for every order in which the modelled motion turns and rests,
/// and no fit converges to the right one. A piece turns twice, so that it holds both directions, and has a start of its
/// own; it is cut half way between turns, where the glider is fast. What shows over longer than a piece only, such as a
/// slow drift, is lost.
#pragma once

#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// Motions with a recorded force that turn more than four times are cut; of all pieces 40 at most are weighed, and of
/// their positions 8000, both spread evenly over clips and time (notes say so). Pieces of fewer than `fewest` points
/// go. The pieces of a clip that is the only one become clips of their own, so that each can be held out.
void cut_driven_motions(TrackSet& set, std::size_t fewest);

/// The points at which a motion turns: where it has come back from by more than its noise or a jitter explains.
std::vector<std::size_t> turns_of(const TrackedMotion& motion);

}  // namespace glidelab::diagnose
