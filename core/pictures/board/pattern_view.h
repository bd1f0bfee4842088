/// One picture of the calibration pattern, as plain data: where its corners are and how well the camera explains them.
#pragma once

#include <string>
#include <vector>

namespace glidelab::core {

struct PixelPlace {
  double u_px = 0.0;
  double v_px = 0.0;
};

struct PatternView {
  std::string file;  ///< without its folder
  bool plane = false;
  double rms_px = 0.0;    ///< of one coordinate of a corner, from where camera and pose put it
  double tilt_deg = 0.0;  ///< between the pattern's normal and the optical axis
  std::vector<PixelPlace> corners;
};

}  // namespace glidelab::core
