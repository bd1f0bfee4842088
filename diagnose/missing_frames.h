/// Frames that are missing from a clip, later ones moved up: all later positions are ahead by one or more frames' way.
///
/// First those for all to see: a step that is longer than the median of the six around it by a whole number of such
/// steps (within 0.2), where those six are alike, and the next step is an ordinary one. Then one by one those that
/// raise the likelihood most, until none raises it by 12.
#pragma once

#include "diagnose/frame_effects.h"

namespace glidelab::diagnose {

/// What was found; the fit that goes with them has their lateness.
struct MissingFrames {
  FrameEffect effect;
  std::size_t count = 0;
  MotionFit fit;
};
MissingFrames find_missing_frames(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
