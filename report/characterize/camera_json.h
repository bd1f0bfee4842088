/// characterize.json, and the table of a measured camera.
#pragma once

#include <string>

#include "core/characterize/camera_measurement.h"

namespace glidelab::report {

/// Each number as {"value", "sd", "how"}, or null with the reason in "why" beside it (and its limit in "limit").
std::string camera_json(const core::CameraMeasurement& camera);

/// The same as a table for a terminal, with notes and reasons below.
std::string camera_text(const core::CameraMeasurement& camera);

}  // namespace glidelab::report
