#include "diagnose/pictures/image_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math/log_sum.h"

namespace glidelab::diagnose {

ImageFinding finding_of(std::string_view id) {
  ImageFinding finding;
  finding.id = id;
  return finding;
}

double stated_line_s(const core::CameraSettings& camera) {
  if (camera.shutter == core::Shutter::global) return 0.0;
  return camera.bottom_row_first ? -camera.line_readout_s : camera.line_readout_s;
}

double log_deviation_evidence(double z, double largest) {
  std::vector<double> logs;
  for (double s = 1.0; s < std::max(2.0, largest); s *= 1.25) logs.push_back(z * s - 0.5 * s * s);
  return base::log_mean(logs);
}

double log_either_sign_evidence(double z, double largest) {
  return base::log_mean({log_deviation_evidence(z, largest), log_deviation_evidence(-z, largest)});
}

}  // namespace glidelab::diagnose
