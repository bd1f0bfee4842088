/// When a clip's frames, and the rows of each, are actually exposed; which frames reach the file, and what the file
/// states about their times.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace glidelab::render {

/// A rolling or a global shutter: when each row of an image is exposed.
///
/// All rows are exposed for the same duration. A global shutter starts them together; a rolling one starts each row
/// `line_readout_s` after the previous one, beginning at the image's top or bottom row. A frame's time is that of the
/// middle of the exposure of the image's middle row (height - 1)/2, as in the experiment folder.
struct Shutter {
  bool rolling = false;
  double line_readout_s = 0.0;  ///< 0 for a global shutter
  bool bottom_first = false;
  int rows = 1;  ///< of the image

  /// The delay of a row's exposure after that of the first row: clip_renderer.cpp draws each row at its own time.
  double delay_s(double row) const { return line_readout_s * (bottom_first ? rows - 1 - row : row); }
  /// From the start of the first row's exposure to the start of the last one's.
  double readout_s() const { return line_readout_s * (rows - 1); }
};

struct ClockSetup {
  double rate_error_ppm = 0.0;  ///< excess of the camera's rate over the stated one
  double jitter_s = 0.0;        ///< standard deviation of the exposures' starts
  double dropped_fraction = 0.0;
  double duplicated_fraction = 0.0;
  bool variable = false;      ///< the container has a true time stamp for every frame
  double stamp_tick_s = 0.0;  ///< the stamps are rounded to this; 0: to the container's tick only
};

/// Jitter does not exceed this many standard deviations (random_numbers.h).
inline constexpr double kLargestJitter = 5.9;

enum class FrameFate { recorded, dropped, duplicated };

/// When the frames of a clip are actually exposed, which of them reach the file, and what the file states about their
/// times. A function of the seed, the clip and the slot.
///
///     start of slot k = k / (rate (1 + error)) + jitter_k        (jitter_0 = 0; normal, white)
///     stamp of slot k = k / rate + jitter_k (1 + error), rounded to the tick: the same instant on the camera's
///                       own clock
///
/// A slot's image is recorded; or dropped: it is not in the file, and in a file of constant rate the later ones move
/// up; or duplicated: the file repeats the previous image, like software that fills an empty slot. The first slot is
/// always recorded.
class FrameClock {
 public:
  FrameClock(const ClockSetup& setup, double frame_rate_hz, std::uint64_t seed, std::uint32_t stream);

  /// True frames per second.
  double true_rate_hz() const { return rate_hz_ * (1.0 + 1e-6 * setup_.rate_error_ppm); }
  /// On sim's clock, from the start of slot `from` to that of slot `to`.
  double between_s(std::size_t from, std::size_t to) const;
  double start_s(std::size_t slot) const { return between_s(0, slot); }
  double stamp_s(std::size_t slot) const;
  FrameFate fate(std::size_t slot) const;
  /// How many of the first `slots` yield a frame of the file.
  std::size_t frames_of(std::size_t slots) const;

 private:
  double jitter_s(std::size_t slot) const;

  ClockSetup setup_;
  double rate_hz_;
  std::uint64_t seed_;
  std::uint32_t stream_;
};

}  // namespace glidelab::render
