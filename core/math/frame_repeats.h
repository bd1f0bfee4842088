/// Finds frames that show the image of the frame before, from the motion: the body stands still for a frame, then goes
/// on.
///
/// A recorder that has lost a frame may repeat the one before in its place; the next step of the body is then as long
/// as two, and all other times are right. A converter to a higher rate repeats frames at even intervals, and the body
/// goes on as if nothing had happened. With q the camera's rate over the file's, frame f of the file shows
///
///     s(f) = floor(q f + phi),   which the camera took   T frac(q f + phi) / q   before the file's time f T,
///
/// up to a constant. A step is a repeat if it is less than a fifth of the mean over six frames on either side, and
/// whole steps follow within eight frames before and after it. Steps between a fifth and a half tell that something
/// else stops the body. Nothing is found where a mean step is below eight standard deviations of a position: where a
/// body is slow, a repeat matters little. The cadence (q, phi) must agree with every step that was told, repeat or not;
/// q is the simplest fraction that does.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

/// What a converter made of a film: it shows each image of the camera q^-1 times.
struct FrameCadence {
  double rate_ratio = 1.0;  ///< q, below 1
  double phase = 0.0;       ///< phi

  /// By how many frames of the file its image was taken before the file says so. Repeats get times of their own,
  /// between those of two images.
  double early_frames(std::size_t frame) const;
  bool is_repeat(std::size_t frame) const;
};

struct FrameRepeats {
  std::vector<std::size_t> points;      ///< rising; a frame before each has the same image
  bool in_place_of_lost = false;        ///< as a recorder repeats them
  std::optional<FrameCadence> cadence;  ///< as a converter repeats them
};

/// `frame` rises; `x` is the position along the path in any unit. No step is told where the mean is below `least_step`.
/// Empty for fewer than three repeats, or where one step
/// in ten of those that are too short is no repeat.
std::optional<FrameRepeats> frame_repeats(std::span<const std::size_t> frame, std::span<const double> x,
                                          double least_step = 0.0);

}  // namespace glidelab::core
