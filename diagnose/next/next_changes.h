/// What an experimenter could do next: one further clip that differs in one respect, as a fit expects it, or one
/// further measurement of a stated quantity.
///
/// A clip begins inside the range of positions so far, a twentieth of it from its upper or lower end. It lasts as long
/// as the longest one so far (2000 frames at most), or until it leaves that range. Its noise is that of the positions
/// so far: for tracks sd² (1 + c v²), with c from `wider` of the motions (0 where that is empty), for films as in
/// whitening.h. Half the exposure leaves a quarter of what grows with the speed. SI units.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/next_step.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// Launches in each direction at half, once and 1.8 times the speeds so far, with the masses so far and a heavier and a
/// lighter one, on the flattest and the steepest set-up; a level track and a steeper one; twice and half the frame
/// rate; half the exposure, if the scatter of filmed markers grows with their speed; a plumb view (0.05 degrees) of
/// each of these set-ups that has none; the pattern at both ends of the range of positions (0.5 mm); a stopwatch (one
/// frame in ten seconds). If a recorded force moves the glider, no clips, because their forces are unknown. `nominal`
/// is the fit of the nominal model to `set`.
std::vector<Change> feasible_changes(const TrackSet& set, const MotionFit& nominal);

/// The number and kinds of changes, in the order of ChangeKind.
ChangesWeighed weighed(const std::vector<Change>& changes);

/// The index of a new set-up's inclination among the common parameters: after those of the others.
Eigen::Index new_alpha(const TrackSet& set);

/// A fit's parameters for the change's clip. Parameters that each clip has for itself take their average over the clips
/// so far. The change must have a clip.
FitPoint next_point(const TrackSet& set, const MotionFit& fit, const Change& change);

/// A further clip as a fit expects it.
struct NextMotion {
  TrackSet set;  ///< the set-ups, masses and clips so far and the change's, whose motion is the only one
  Moved moved;   ///< empty if the clip is not feasible: fewer than 12 positions within the range so far
};

/// The change's clip as the fit predicts it, recorded after all others and without a deviation of its own
/// (clip_scatter), without noise, cut where it leaves the range of positions so far.
NextMotion next_motion(const TrackSet& set, const MotionFit& fit, const Change& change);

}  // namespace glidelab::diagnose
