/// Truth against estimate as plots: errors in units of their standard deviation, and restitution over the field.
#pragma once

#include <vector>

#include "core/result/results.h"
#include "report/html/plot.h"
#include "validate/truth/comparison.h"

namespace glidelab::report {

/// Errors of the recovered values, of the positions over the field, and of the centres within their pixels; each only
/// where there is something to compare.
std::vector<Plot> validation_plots(const core::AnalysisResults& results, const validate::Comparison& comparison);

}  // namespace glidelab::report
