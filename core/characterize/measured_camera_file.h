/// A measured camera as a file: the keys of a scenario's [sensor], each with its standard deviation in a comment.
///
/// A number that was not measured but has a limit stands at that limit, so that a rehearsal with the file is on the
/// side of caution; the comment says so. One without even a limit stands as nan, which no reader takes for a number:
/// whoever uses the file has to decide. A dark signal that was not measured is left out; at exposures of milliseconds
/// it does not matter.
#pragma once

#include <string>

#include "core/characterize/camera_measurement.h"

namespace glidelab::core {

/// TOML 1.0. Numbers with no more digits than their standard deviations support.
std::string camera_toml(const CameraMeasurement& camera);

}  // namespace glidelab::core
