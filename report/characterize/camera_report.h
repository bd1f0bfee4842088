/// The page of a measured camera: its numbers, the photon-transfer diagram, what was noticed.
#pragma once

#include <string>

#include "core/characterize/camera_measurement.h"
#include "report/html/html.h"

namespace glidelab::report {

/// A self-contained HTML page. EnvironmentError if gnuplot fails.
Page camera_report(const core::CameraMeasurement& camera);

}  // namespace glidelab::report
