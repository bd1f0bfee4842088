/// Whether one point of a requirement (validate/requirement.h) reaches its targets, by runs; and what keeps it from
/// that.
#pragma once

#include <cstdint>
#include <vector>

#include "validate/requirement.h"
#include "validate/requirement_bound.h"
#include "validate/sweep.h"

namespace glidelab::validate {

/// Fills `results` (one for each target) with the better estimator's errors over the runs; true where all targets are
/// reached.
bool reached_by_runs(const Sweep& sweep, const Setting& setting, std::uint64_t point, const RequirementOptions& options,
                     std::vector<TargetResult>& results);

/// What is in no bound, thought away one by one, by the same runs: how many times smaller the errors in `results` are
/// with an even clock; and, where clips are rendered, with a global shutter, with a lossless codec, and with the true
/// positions and the noise that the camera lets one expect (no lens, no calibration, no tracker).
std::vector<Limit> limits_by_runs(const Sweep& sweep, const Setting& setting, std::uint64_t point,
                                  const RequirementOptions& options, const std::vector<TargetResult>& results);

}  // namespace glidelab::validate
