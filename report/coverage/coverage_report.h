/// How often intervals contain the truth (validate/study/coverage/interval_coverage.h): coverage.json, its table for a
/// terminal, its page, its plots.
#pragma once

#include <string>

#include "report/html/html.h"
#include "report/html/plot.h"
#include "validate/study/coverage/interval_coverage.h"

namespace glidelab::report {

/// Coverage of every row's 95 % intervals with its binomial interval, a line at 95 %.
Plot coverage_plot(const validate::Coverage& coverage);

/// Actual against nominal coverage, with a point for every row and level, and the binomial band of the replicates.
Plot reliability_plot(const validate::Coverage& coverage);

/// One JSON object, with a newline at its end. No number in it is NaN.
std::string coverage_json(const validate::Coverage& coverage);

/// How often the intervals of all estimators except the naive one contain the truth, and which do so less often than
/// stated, as one sentence; empty if there is nothing to count.
std::string coverage_answer(const validate::Coverage& coverage);

/// That sentence, every quantity, and below it how often the intervals of every level contain the truth.
std::string coverage_text(const validate::Coverage& coverage);

/// The same as a page, with its meaning first. EnvironmentError if gnuplot fails.
Page coverage_page(const std::string& title, const validate::Coverage& coverage);

}  // namespace glidelab::report
