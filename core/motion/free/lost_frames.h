/// Frames that are missing from a file of constant rate and leave no gap in its times, found from the motion.
///
/// When a camera drops a frame and the file numbers its frames consecutively, everything after the loss is too early by
/// one frame's time T. The positions then jump by v T, far more than their noise wherever the glider is not slow. At
/// each pair of neighbouring frames a cubic goes through up to four positions before and four behind, the latter at
/// times that are later by tau = 0, T, 2T, … kMostLost T. With S(tau) the sum of the squared residuals, frames are lost
/// where for the best m > 0
///
///     S(0) - S(mT)  is above 50 variances of what is left about the cubic (7 standard deviations), or of the noise,
///     S(mT)         is small: four standard deviations of the noise, or a tenth of the distance in a frame (no
///                   cubic is exact where friction turns),
///     the tau of least S, to first order about mT, is mT within a seventh of T, and known to that.
///
/// An impact, a push or a single wrong position makes no jump of a whole frame's distance with the same smooth motion
/// on both sides, and a reversal has no distance to jump. Where the window holds a turn, the acceleration may step
/// there, as dry friction makes it. A frame alone between two losses is placed by the cubic through those around it.
/// Not found: what is lost before the second or behind the last but one frame, or where |v| T is below some 15 standard
/// deviations of the noise (and there it matters little).
#pragma once

#include <vector>

#include "core/motion/free/motion.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

inline constexpr int kMostLost = 8;

/// In the order of time; none where the frames' times are not uniform to a tenth of a step (stamps that show gaps are
/// trusted). `motion` is the track's; single outliers in it are passed over.
std::vector<LostFrames> find_lost_frames(const TrackData& track, const Motion& motion);

/// The file's time with the frames counted in that were lost before it.
double put_right(double file_s, const std::vector<LostFrames>& lost, double step_s);

/// The track with all times corrected.
TrackData put_right(TrackData track, const std::vector<LostFrames>& lost);

}  // namespace glidelab::core
