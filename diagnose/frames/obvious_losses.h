/// Frames that are obviously missing, found before anything is fitted to the whole motion.
///
/// Around such a place the positions make a parabola only if all from there on are later by whole frames: with S(k) the
/// squares that it leaves over the noise, k of them lost, (S(0) - S(k))/2 is above 14 and S(k) below four a point, or
/// below 0.3 S(0).
#pragma once

#include <cstddef>

#include "diagnose/fit/linearised_motion.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// How late each point is for the frames that are lost before it, and how many these are in all.
struct LostBefore {
  Lateness late;
  std::size_t count = 0;
};

/// The clearest first, as one may hide another near by. Where the stamps themselves show a gap they are believed.
LostBefore plain_losses(const TrackSet& set);

/// Those that the analysis finds (core/lost_frames.h), clip by clip.
LostBefore analysed_losses(const TrackSet& set);

}  // namespace glidelab::diagnose
