#include "diagnose/pictures/picture_finding.h"

#include <algorithm>
#include <vector>

#include "diagnose/fit/score_space.h"

namespace glidelab::diagnose {

PictureFinding finding_of(std::string_view id) {
  PictureFinding finding;
  finding.id = id;
  return finding;
}

double stated_line_s(const core::CameraSettings& camera) {
  if (camera.shutter == core::Shutter::global) return 0.0;
  return camera.bottom_row_first ? -camera.line_readout_s : camera.line_readout_s;
}

double log_evidence_of(double z, double largest) {
  std::vector<double> logs;
  for (double s = 1.0; s < std::max(2.0, largest); s *= 1.25) logs.push_back(z * s - 0.5 * s * s);
  return log_mean(logs);
}

}  // namespace glidelab::diagnose
