/// report.html of `sweep`: error, stated standard deviation and coverage of every quantity over each varied key.
#pragma once

#include <string>

#include "base/progress.h"
#include "report/html/html.h"
#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// EnvironmentError if gnuplot fails.
Page sweep_report(const validate::SweepSummary& summary, const base::Progress& progress = base::no_progress);

/// The table over all runs, for a terminal.
std::string sweep_text(const validate::SweepSummary& summary);

/// The same as one JSON object.
std::string sweep_json(const validate::SweepSummary& summary);

}  // namespace glidelab::report
