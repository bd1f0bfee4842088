/// A rolling or a global shutter: when each row of a frame is exposed.
#pragma once

namespace glidelab::render {

/// When each row of the image is exposed.
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

}  // namespace glidelab::render
