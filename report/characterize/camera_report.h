/// A measured camera as characterize.json, as a table and as a page, and the rows shared by these three.
#pragma once

#include <string>
#include <vector>

#include "core/characterize/camera_measurement.h"
#include "report/html/html.h"

namespace glidelab::report {

/// One number in readable form.
struct CameraRow {
  std::string key;   ///< in JSON, and in camera.toml
  std::string name;  ///< "read noise"
  std::string value;
  std::string sd;
  std::string unit;
  const core::Measured* measured = nullptr;  ///< in the given CameraMeasurement
};

/// The rows in the common order; PRNU and linearity in per cent, as texts. A limit reads "< 3.2" or "> 5400".
std::vector<CameraRow> camera_rows(const core::CameraMeasurement& camera);

/// Each number as {"value", "sd", "how"}, or null with the reason in "why" next to it (and its limit in "limit").
std::string camera_json(const core::CameraMeasurement& camera);

/// The same as a table for a terminal, with notes and reasons below.
std::string camera_text(const core::CameraMeasurement& camera);

/// The page of a measured camera, self-contained HTML: its numbers, the photon-transfer diagram, and its notes.
/// EnvironmentError if gnuplot fails.
Page camera_report(const core::CameraMeasurement& camera);

}  // namespace glidelab::report
