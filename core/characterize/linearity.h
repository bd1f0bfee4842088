/// The linearity of a camera: mean above dark against exposure, under a light that stays the same.
///
///     mean_i = a0 + a1 exposure_i  by least squares with weights 1 / mean_i²,   error = mean of |mean_i / line_i - 1|
///
/// over the levels from 5 % to 95 % of saturation (EMVA standard 1288, release 3.1: the regression of relative
/// deviations).
#pragma once

#include "core/characterize/camera_measurement.h"
#include "core/characterize/flat_field_folder.h"
#include "core/characterize/photon_numbers.h"

namespace glidelab::core {

/// Why, instead of a value, where fewer than three levels have exposures that differ. The standard deviation holds the
/// scatter of the frames' means within each level, not a light that drifts from level to level.
Measured linearity_error(const Evidence& evidence, const FlatFieldFolder& folder, double saturation_dn);

}  // namespace glidelab::core
