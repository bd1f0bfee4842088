/// The plots of a table of lines.
#pragma once

#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// The friction that the nominal model leaves in each line's intercept, over 1/m and over (K/m)², with what each effect
/// that acts on intercepts makes of it.
std::vector<Plot> line_plots(const diagnose::LineComparison& lines);

}  // namespace glidelab::report
