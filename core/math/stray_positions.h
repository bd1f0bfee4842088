/// Positions of something else: a motion sensor that hears another object for a while, a tracker on another mark.
///
/// A body does not jump. A run of three positions or more, at most a tenth of all, is not of the body if steps at more
/// than four times the speed of the motion lead to it and from it, none lies within it, and the path goes on behind it
/// where it ended before: the lines through the six positions on either side meet halfway to within a quarter of the
/// smaller jump. At the start and at the end of a recording, where nothing shows the way back, a run of at most a
/// twentieth of all positions is not of the body if the jump has more than twelve times the speed of the motion: more
/// than frames that were lost would make of it.
///
/// Nor does a recording belong to one body on both sides of a jump at more than twelve times the speed of either side,
/// with an acceleration above 20 g, from which no later jump leads back: an echo, then what lies where the body landed,
/// or a hand. The motion is the stretch between such jumps with the widest range of positions, if no other has half of
/// it, and all others are left out, however long; otherwise nothing shows which is the motion, and all stay.
///
/// The speed of the motion at a jump is that of nine tenths of all steps that are not 0 or, if larger, the median of
/// the six nearest steps on the side of the motion. Single positions and pairs are outliers (find_outliers).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

struct StrayPositions {
  std::vector<bool> is_stray;  ///< of each position
  std::size_t count = 0;
  double from_s = 0.0;  ///< the time of the first of them
  double off = 0.0;     ///< the largest jump
};

/// Times rise. None if nothing strays, or if fewer than eight steps show the speed of the motion.
std::optional<StrayPositions> stray_positions(std::span<const double> t_s, std::span<const double> x);

}  // namespace glidelab::core
