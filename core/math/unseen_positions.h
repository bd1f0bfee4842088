/// Values that a sensor or a tracker writes while it sees nothing: the same number again and again, usually 0, far from
/// where the body is.
///
/// A body does not jump. A run of four exactly equal values or more is not a place of the body if all of its sides (one
/// at the start or the end of the recording, both in between) are jumps: steps at more than four times the speed of the
/// motion, both that of nine tenths of all steps that touch no value of such runs and the median of the six of them
/// nearest to the jump.
/// A rest is reached and left at the speed of the motion, however coarse the positions or the times are.
///
/// A value found in this way means the same elsewhere: runs of four at this value are not places either, nor are
/// shorter ones with jumps on all sides.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

struct UnseenPositions {
  std::vector<bool> is_unseen;  ///< of each position
  std::size_t count = 0;
  double value = 0.0;   ///< of the first of them
  double from_s = 0.0;  ///< its time
};

/// Times rise. None if nothing is unseen, or if fewer than eight steps outside the runs show the speed of the motion.
std::optional<UnseenPositions> unseen_positions(std::span<const double> t_s, std::span<const double> x);

/// The values without the flagged ones.
std::vector<double> without_flagged(const std::vector<double>& values, const std::vector<bool>& flagged);

}  // namespace glidelab::core
