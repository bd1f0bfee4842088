/// Plots of how often intervals hold the truth (validate/study/coverage/interval_coverage.h).
#pragma once

#include <string>

#include "report/html/plot.h"
#include "validate/study/coverage/interval_coverage.h"

namespace glidelab::report {

/// Coverage of every row's 95 % intervals with its binomial interval, a line at 95 %.
Plot coverage_plot(const validate::Coverage& coverage);

/// Actual over nominal coverage, every row a point at every level, with the binomial band of the replicates.
Plot reliability_plot(const validate::Coverage& coverage);

}  // namespace glidelab::report
