/// Plots of a sweep: of one quantity against one varied key.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "report/html/plot.h"
#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// RMS error with stated sd and bound, for each configuration if the axis has them separately (`configurations` of the
/// same summary), otherwise for all; bias with its standard error; coverage. Empty if no run has an answer.
std::vector<Plot> sweep_plots(const validate::AxisSummary& axis, std::string_view quantity,
                              std::span<const validate::ConfigurationSummary> configurations = {});

}  // namespace glidelab::report
