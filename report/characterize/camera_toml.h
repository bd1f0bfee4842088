/// A measured camera as a file.
#pragma once

#include <string>

#include "core/characterize/camera_measurement.h"

namespace glidelab::report {

/// A measured camera as a file: the keys of a scenario's [sensor], each with its standard deviation in a comment. TOML
/// 1.0. Numbers have no more digits than their standard deviations support.
///
/// A number that was not measured but has a limit is written as that limit, so that a rehearsal with the file errs on
/// the side of caution; the comment says so. A number without a limit is written as nan, which no reader accepts: the
/// user of the file has to decide. A dark signal that was not measured is left out; at exposures of milliseconds it
/// does not matter.
std::string camera_toml(const core::CameraMeasurement& camera);

}  // namespace glidelab::report
