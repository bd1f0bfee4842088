/// A clip smoothed as a whole, by a smoother that chooses its own strength (smoothing/smoother.h).
///
/// The free motion has one strength, and the rest (a hand, a stop, a rest) another. Where the motion turns, both sides
/// are smoothed together with a jump of a, because dry friction jumps there while x and v are continuous; elsewhere
/// every part starts afresh. Points count for lines where the variance of a is below kEndVariance of its median over
/// their direction, or the standard deviation below 2 % of the range of a in the stretch.
#pragma once

#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/free/motion_events.h"
#include "core/motion/lines/line_fit.h"
#include "core/motion/smoothing/smoother.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// The relative variance of the local cubic at its margin of kKernelMargin bandwidths.
inline constexpr double kEndVariance = 1.64;

struct SmoothedWhole {
  SmoothingStrength strength;        ///< of the free motion
  std::vector<StretchPoint> points;  ///< of the free stretches, with their rows
  std::vector<MotionPoint> frames;   ///< all; `left_out` is not set
  /// Of each point, if the smoothed motion has no rate: v and a less those under the most likely rate
  /// (SmoothedSeries::with_rate). Otherwise empty.
  std::vector<MotionShift> without_rate;
  /// Of each point, with the smoother's rate held; empty if the points' own rows hold it.
  std::vector<std::optional<KernelRow>> held_rows;
};

/// With a known force the strength is that of y, and x is smoothed by the same weights.
SmoothedWhole smooth_whole(const Smoother& smoother, const TrackData& track, const Motion& motion,
                           const FreeMotion& free, double mass_kg);

/// The law a = a0 - k v of the lines through the smoothed points, at each point of the motion; where a direction has no
/// line, or a point is not smoothed, that of `pilot_m_s2`. A smoother that follows k has no bias under its own law;
/// under another, what it would show is the difference of the two.
std::vector<double> own_law(const std::vector<double>& pilot_m_s2, const SmoothedWhole& whole);

/// Like smoothing_bias() of line_fit.h, with motions that continue through their turns.
std::vector<double> smoothing_bias(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                   const std::vector<double>& law_m_s2, const SmoothedWhole& whole);

/// Consecutive points that are smoothed together: the stretches, and the pieces between two of them.
std::vector<PointRange> pieces_of(const std::vector<FreeStretch>& stretches, std::size_t points);

/// The frames of a track with their times and what was measured.
std::vector<MotionPoint> measured_frames(const TrackData& track);

}  // namespace glidelab::core
