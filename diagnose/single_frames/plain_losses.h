/// Lost frames that show without a search along a fit: by a jump in the path, or by a gap next to an end of a clip.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// The delay of each point due to the frames lost before it, and the total number of these.
struct LostBefore {
  Lateness late;
  std::size_t count = 0;
};

/// Frames that are obviously missing, found before anything is fitted to the whole motion. Around such a place the
/// positions make a parabola only if all from there on are later by whole frames. With S(k) the squares that the
/// parabola leaves over the noise, k frames being lost, (S(0) - S(k))/2 is above 14, and S(k) is below four per point
/// or below 0.3 S(0).
///
/// The clearest come first, because one may hide another nearby. Where the time stamps themselves show a gap, they are
/// trusted.
LostBefore plain_losses(const TrackSet& set);

/// The lost frames that the analysis finds (core/motion/free/lost_frames.h), clip by clip.
LostBefore analysed_losses(const TrackSet& set);

struct EdgePosition {
  std::size_t motion = 0, point = 0;
};

/// Positions beyond a gap: frames are missing right after a clip's first frames or right before its last.
///
/// The few positions on the far side of such a gap lie off the rest, and so the analysis takes them for outliers. They
/// are not outliers if all of them lie on the path of the others, each the same whole number of frames earlier (the
/// first ones) or later (the last ones).
///
/// Returned are the outliers among the first and last three positions of each motion that a gap of one to five frames
/// explains. They lie within four standard deviations of the path of `fit` that many frames away, continued by the
/// fourth-order polynomial through its nearest five points, and more than six off it at their own times. Nothing is
/// returned if the glider hardly moves (less than ten standard deviations per frame). No NumericalError.
std::vector<EdgePosition> positions_beyond_gaps(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
