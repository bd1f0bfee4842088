/// Plots of a sweep: of one quantity over one varied key.
#pragma once

#include <string_view>
#include <vector>

#include "report/plot.h"
#include "validate/sweep_summary.h"

namespace glidelab::report {

/// Three plots: rms error with stated sd and bound; bias with its standard error; coverage. Empty where no run has an
/// answer.
std::vector<Plot> sweep_plots(const validate::AxisSummary& axis, std::string_view quantity);

}  // namespace glidelab::report
