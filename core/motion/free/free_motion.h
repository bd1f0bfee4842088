/// The free parts of a measured motion: not in the hand, not at rest, not against a stop or a bumper, each in one
/// direction.
///
/// A first smoothing (the pilot) takes the smallest bandwidth at which the noise of a is 10 % of the median |a| of the
/// moving glider. From it:
///  - Directions, reversals and rests are told apart (motion_events.h).
///  - Hand, stop: the points (v, a) of one direction of free motion lie about one line. For each direction the line is
///    taken on which most points agree (candidates: lines through parts of the motion that are contiguous in time). A
///    point is not free if its a is off that line by more than a quarter of the line's own size AND by more than the
///    noise and the common scatter of the points allow (five standard deviations). Before the first free stretch this
///    is the hand, later a stop. Smaller deviations are left in: they are physics, not handling. In a fall (a stated
///    inclination of 80 degrees or more) every acceleration between 0 and g is: it speeds up towards a terminal
///    velocity, and where the drag grows with the square of the speed no line holds for all of it. (Of fewer than 24
///    points the pilot does not show that well enough. A hand that lowers the body looks the same: start_s tells.)
///  - The ends of a fall (fall_ends.h): positions of a body that is held before it falls, or that lies on the floor,
///    are at rest, however few.
///  - A stretch of duration T determines its acceleration with a standard deviation proportional to T^(-5/2). A stretch
///    whose standard deviation is four times that of the longest of its direction (T below 0.57 of it) is left out:
///    least squares gives all points the same weight, so its points would add noise and no information.
///  - A stretch of the wrong direction before the first one in the direction of the launch is the hand's backswing. If
///    the direction of the launch is not stated, there is no wrong direction.
///
/// Assumptions: most of the motion is free; a hand or a bumper differs from free motion by more than a quarter. Each
/// stretch is later smoothed with its own points alone, so that no kernel reaches over a reversal, a rest, an impact or
/// a release; the times of these need to be known only well enough to keep the far side out.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/motion/free/fall_ends.h"
#include "core/motion/free/motion.h"
#include "core/result/results.h"

namespace glidelab::core {

/// Points of one direction in order of time; `sd` is the standard deviation of a due to the noise of the positions.
struct LawPoints {
  std::vector<double> v_m_s;
  std::vector<double> a_m_s2;
  std::vector<double> sd_m_s2;
};

/// The line a = a0 - k v with which most points of one direction agree, regardless of outliers.
struct ConsensusLine {
  double a0_m_s2 = 0.0;
  double k_1_s = 0.0;
  double size_m_s2 = 0.0;  ///< the 90 % quantile of |a0 - k v| over its points
  double scatter = 1.0;    ///< robust standard deviation of its points about it, in units of their sd; at least 1
  double at(double v_m_s) const { return a0_m_s2 - k_1_s * v_m_s; }
  /// How far a point may lie from the line and still count.
  double tolerance(double sd_m_s2) const;
};

/// Candidates are the least-squares lines through runs of consecutive points; the one with the most points within its
/// tolerance wins and is refitted to them. Empty for fewer than six points.
std::optional<ConsensusLine> find_consensus(const LawPoints& points);

/// Points first … first + count - 1 of the motion, all moving freely in one direction.
struct FreeStretch {
  std::size_t first = 0;
  std::size_t count = 0;
  int direction = 0;
  LeftOut start = LeftOut::kernel_end;  ///< what precedes it: kernel_end or kernel_reversal
  LeftOut end = LeftOut::kernel_end;    ///< what follows it
  LeftOut whole = LeftOut::used;        ///< short_stretch if none of it counts
};

/// Whether the motion turns between two consecutive stretches, with no point in between.
bool turns_into(const FreeStretch& before, const FreeStretch& after);

struct FreeMotion {
  std::vector<FreeStretch> stretches;  ///< in order of time; they share no point
  std::vector<LeftOut> reason;         ///< of every point; `used` within the stretches
  double pilot_bandwidth_s = 0.0;
  std::size_t released_at = 0;  ///< the first point of a fall at which the body is known to be free
  std::optional<AgainstLaunch> against_launch;
};

/// The setup's start_s and end_s, if given, are trusted: nothing after start_s counts as hand, nothing before end_s as
/// stop or rest, and with both everything between them is free, at rest or not.
FreeMotion find_free_motion(const Motion& motion, const ClipSetup& setup);

/// Free stretches joined where the motion turns.
///
/// Consecutive stretches across a reversal make one block. If a block borders on something that is not free (a hand, a
/// stop, a rest), `margin_s` of it is left out: the border is known to about a bandwidth (the release of a fall
/// better). Blocks of fewer than kFewestBlockPoints, and those in which no stretch counts, are left out.
///
/// If a recorded force drives the glider to and fro, a block ends in the middle of its third stretch, where the glider
/// is fast, and the next block begins there: over more than two turns, an incomplete law makes the fit end in a local
/// minimum with the wrong sequence of turns.
std::vector<FreeBlock> free_blocks(const Motion& motion, const FreeMotion& free,
                                   const std::vector<std::vector<double>>& shared_m, double margin_s);

/// The force of a track divided by the mass, at its samples from the block's first point to its last.
RecordedForce force_over(const FreeBlock& block, const TrackData& track, double mass_kg, double mass_sd_kg);

}  // namespace glidelab::core
