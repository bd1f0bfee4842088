/// Plots of a sweep: of one quantity over one varied key.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "report/html/plot.h"
#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// Rms error with stated sd and bound, of each configuration where the axis has them apart (`configurations` of the
/// same summary), else of all; bias with its standard error; coverage. Empty if no run has an answer.
std::vector<Plot> sweep_plots(const validate::AxisSummary& axis, std::string_view quantity,
                              std::span<const validate::ConfigurationSummary> configurations = {});

}  // namespace glidelab::report
