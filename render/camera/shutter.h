/// Which row of the image is exposed when.
///
/// All rows are exposed equally long. A global shutter starts them together; a rolling one starts a row
/// `line_readout_s` after the one before, from the image's top row or from its bottom row on. A frame's time belongs
/// to the middle of the exposure of the image's middle row (height - 1)/2, as the experiment folder says.
#pragma once

#include <cmath>

namespace glidelab::render {

struct Shutter {
  bool rolling = false;
  double line_readout_s = 0.0;  ///< 0 for a global shutter
  bool bottom_first = false;
  int rows = 1;  ///< of the image

  /// How much later than the first row's a row's exposure starts; also between rows.
  double delay_s(double row) const { return line_readout_s * (bottom_first ? rows - 1 - row : row); }
  /// From the start of the first row's exposure to the start of the last one's.
  double readout_s() const { return line_readout_s * (rows - 1); }
};

}  // namespace glidelab::render
