/// The numbers of a measured camera as a person reads them, in one order for table, page and JSON.
#pragma once

#include <string>
#include <vector>

#include "core/characterize/camera_measurement.h"

namespace glidelab::report {

struct CameraRow {
  std::string key;   ///< in JSON, and in camera.toml
  std::string name;  ///< "read noise"
  std::string value;
  std::string sd;
  std::string unit;
  const core::Measured* measured = nullptr;  ///< in the CameraMeasurement that was given
};

/// PRNU and linearity in per cent, as texts. A limit reads "< 3.2" or "> 5400".
std::vector<CameraRow> camera_rows(const core::CameraMeasurement& camera);

}  // namespace glidelab::report
