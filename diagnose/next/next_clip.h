/// A further clip (next_changes.h) as a fit expects it: the set of tracks that holds nothing but it, and the fit's
/// parameters for it.
#pragma once

#include <Eigen/Core>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/next/next_changes.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// Where a new set-up's inclination stands among the common parameters: behind those of the others.
Eigen::Index new_alpha(const TrackSet& set);

/// A fit's parameters for the change's clip. What every clip has of its own is as in the clips so far, on average. The
/// change must have a clip.
FitPoint next_point(const TrackSet& set, const MotionFit& fit, const Change& change);

struct NextMotion {
  TrackSet set;  ///< the set-ups and masses so far and the change's, with its clip as the only one
  Moved moved;   ///< empty where the clip cannot be made: fewer than 12 positions within the range so far
};

/// The change's clip as the fit makes it, without noise, cut where it leaves the places so far.
NextMotion next_motion(const TrackSet& set, const MotionFit& fit, const Change& change);

}  // namespace glidelab::diagnose
