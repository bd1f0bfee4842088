/// Positions in a recording that are not the body's. A body does not jump, so that positions behind a jump are not its
/// own.
///
/// A jump is a step at more than four times the speed of the motion. That is the speed of nine tenths of all steps or,
/// if larger, the median of the six steps nearest to the jump on the side of the motion.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

/// Values that a sensor or a tracker writes while it sees nothing: the same number again and again, usually 0, far from
/// where the body is.
struct UnseenPositions {
  std::vector<bool> is_unseen;  ///< of each position
  std::size_t count = 0;
  double value = 0.0;   ///< of the first of them
  double from_s = 0.0;  ///< its time
};

/// A run of four exactly equal values or more is not a place of the body if all of its sides (one at the start or the
/// end of the recording, both in between) are jumps. Steps that touch a value of such runs do not count for the speed
/// of the motion. A rest is reached and left at that speed, however coarse the positions or the times are.
///
/// A value found in this way means the same elsewhere: runs of four at this value are not places either, nor are
/// shorter ones with jumps on all sides. Of a value that also stays for four or more, such a short run within the
/// recording is enough: zeros before a body comes into view, near to where it then is, and zeros where it was lost.
///
/// Times rise. None if nothing is unseen, or if fewer than eight steps outside the runs show the speed of the motion.
std::optional<UnseenPositions> unseen_positions(std::span<const double> t_s, std::span<const double> x);

/// Positions of something else: a motion sensor that hears another object for a while, a tracker on another mark.
struct StrayPositions {
  std::vector<bool> is_stray;  ///< of each position
  std::size_t count = 0;
  double from_s = 0.0;  ///< the time of the first of them
  double off = 0.0;     ///< the largest jump
};

/// A run of three positions or more, at most a tenth of all, is not of the body if jumps lead to it and from it, none
/// lies within it, and the path goes on behind it where it ended before: the lines through the six positions on either
/// side meet halfway to within a quarter of the smaller jump. At the start and at the end of a recording, where nothing
/// shows the way back, a run of at most a twentieth of all positions is not of the body if the jump has more than
/// twelve times the speed of the motion: more than frames that were lost would make of it. Steps of 0 do not count for
/// that speed. Single positions and pairs are outliers (find_outliers).
///
/// Nor does a recording belong to one body on both sides of a jump at more than twelve times the speed of either side,
/// with an acceleration above 20 g, from which no later jump leads back: an echo, then what lies where the body landed,
/// or a hand. The motion is the stretch between such jumps with the widest range of positions, if no other has half of
/// it, and all others are left out, however long; otherwise nothing shows which is the motion, and all stay.
///
/// Times rise. None if nothing strays, or if fewer than eight steps show the speed of the motion.
std::optional<StrayPositions> stray_positions(std::span<const double> t_s, std::span<const double> x);

/// How many positions at each end of a recording lie anywhere.
struct ScatteredEnds {
  std::size_t at_start = 0, at_end = 0;
};

/// Before it has found the body, or after it has lost it, a tracker may put it anywhere.
///
/// The path turns at a position if its acceleration there is above both 20 g and twenty times the median one. An end is
/// scattered if it has six turns or more, none of them more than four positions from the next; it goes to the last of
/// them, which is at the body's own place. The median of these turns is above twenty times the acceleration of nine
/// tenths of the positions between the ends, and the median step above twelve times nine tenths of the steps there, so
/// that neither a coarse rounding nor a vibration counts; and between the ends lies half of all positions or more. None
/// is scattered beside a rest in which nine tenths of the positions repeat the one before.
///
/// Times rise. None if no end is scattered.
std::optional<ScatteredEnds> scattered_ends(std::span<const double> t_s, std::span<const double> x);

/// The values without the flagged ones.
std::vector<double> without_flagged(const std::vector<double>& values, const std::vector<bool>& flagged);

}  // namespace glidelab::core
