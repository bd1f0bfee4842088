/// A measured camera as characterize.json, as a table, as camera.toml and as a page; the rows shared by the table, the
/// page and the JSON.
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

/// camera.toml: the keys of a scenario's [sensor], each with its standard deviation in a comment. TOML 1.0.
/// Numbers have no more digits than their standard deviations support.
///
/// A number that was not measured but has a limit is written as that limit, so that a rehearsal with the file errs on
/// the side of caution; the comment says so. A number without a limit is written as nan, which no reader accepts: the
/// user of the file has to decide. A dark signal that was not measured is left out; at exposures of milliseconds it
/// does not matter.
std::string camera_toml(const core::CameraMeasurement& camera);

/// The page of a measured camera, self-contained HTML: its numbers, the photon-transfer diagram, and its notes.
/// EnvironmentError if gnuplot fails.
Page camera_report(const core::CameraMeasurement& camera);

}  // namespace glidelab::report
