/// Finds, from the motion, frames that are missing from a file of constant rate and leave no gap in its times.
///
/// When a camera drops a frame and the file numbers its frames consecutively, everything after the loss is too early by
/// one frame's time T. The positions then jump by v T, far more than their noise unless the glider is slow. At each
/// pair of neighbouring frames a cubic is fitted to up to four positions before and four after, the latter delayed by
/// tau = 0, T, 2T, … kMostLost T. With S(tau) the sum of the squared residuals, frames are lost if for the best m > 0
///
///     S(0) - S(mT)  is above 50 variances of the residuals about the cubic (7 standard deviations), or of the noise,
///     S(mT)         is small: four standard deviations of the noise, or a tenth of the distance per frame (no
///                   cubic is exact where friction turns),
///     the tau of smallest S, to first order about mT, is mT within a seventh of T, and known to that precision.
///
/// An impact, a push or a single wrong position makes no jump of a whole frame's distance with the same smooth motion
/// on both sides, and at a reversal there is no distance to jump. If the window contains a turn, the acceleration may
/// step there, as with dry friction. A single frame between two losses is placed by the cubic through the frames around
/// it. Losses are not found before the second or after the last but one frame, or where |v| T is below about 15
/// standard deviations of the noise (where they matter little).
#pragma once

#include <vector>

#include "core/motion/free/motion.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

inline constexpr int kMostLost = 8;  ///< frames in a row

/// In order of time; none if the frames' times are not uniform to a tenth of a step (time stamps that show gaps are
/// trusted). `motion` is the track's; single outliers in it are skipped.
std::vector<LostFrames> find_lost_frames(const TrackData& track, const Motion& motion);

/// The file's time, corrected for the frames lost before it.
double put_right(double file_s, const std::vector<LostFrames>& lost, double step_s);

/// The track with all times corrected.
TrackData put_right(TrackData track, const std::vector<LostFrames>& lost);

}  // namespace glidelab::core
