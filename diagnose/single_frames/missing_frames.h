/// Frames that are missing from a clip, with the later ones moved up: all later positions are ahead by the distance
/// covered in one or more frames.
///
/// First the obvious ones: around such a place the positions make a parabola only if all from there on are later by
/// whole frames (a gain of 14 in log likelihood), the clearest first; or, if that gives a better fit in the end, those
/// that the analysis finds (core/motion/free/lost_frames.h). Then those that raise the likelihood of the whole fit by
/// 12, one in each motion at a time or all together, with K, mu and the inclination free. Then all of them are placed
/// anew along the fitted path (Viterbi). These count only if they leave chi² below 2 per point: many curves that the
/// model lacks look like a series of losses.
#pragma once

#include "diagnose/single_frames/frame_effects.h"

namespace glidelab::diagnose {

inline constexpr double kLeastFrameGain = 12.0;  ///< log likelihood that a missing frame must gain

/// How many frames are missing according to a fit, over all clips.
std::size_t missing_in(const TrackSet& set, const MotionFit& fit);

/// What was found; the fit that belongs to it includes their delays.
struct MissingFrames {
  FrameEffect effect;
  std::size_t count = 0;
  MotionFit fit;
};
/// Found by `jobs` threads: the same for any number.
MissingFrames find_missing_frames(const TrackSet& set, const MotionFit& fit, int jobs = 1);

/// Further losses that a fit with at least one loss in its times hides. The result has the fit's own losses and these;
/// the effect's gain and evidence are those of the further ones.
MissingFrames find_more_missing_frames(const TrackSet& set, const MotionFit& with_losses);

}  // namespace glidelab::diagnose
