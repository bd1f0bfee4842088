/// results.json: what an analysis found, in the form that other programs read.
///
/// A quantity that the data do not determine is null, and the object "why" beside it says why. Beyond what the form
/// asks for, clips hold their stretches, what was left out, notes and the name of their CSV; configurations their group
/// and lines; every folder's calibration stands in "calibrations" where there are several.
#pragma once

#include <string>

#include "core/result/results.h"

namespace glidelab::report {

/// The text of results.json. It depends on the results alone.
std::string results_json(const core::AnalysisResults& results);

/// "fisheye" or "brown-conrady": a fisheye's distortion has four terms, k1 to k4, the other five.
std::string lens_of(const core::CalibrationResult& calibration);

}  // namespace glidelab::report
