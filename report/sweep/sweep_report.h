/// report.html of `sweep`: error, stated standard deviation and coverage of every quantity against each varied key, and
/// mu against mass.
#pragma once

#include <string>

#include "base/long_work.h"
#include "report/html/html.h"
#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// The section of a sweep's page on whether mu falls with mass (validate/study/sweep/mass_study.h, as part of the
/// summary). HTML: the answer in words if the sweep names published values, and the table. Empty for any other sweep.
std::string mass_study_section(const validate::MassStudy& study);

/// EnvironmentError if gnuplot fails.
Page sweep_report(const validate::SweepSummary& summary, const base::Progress& progress = base::no_progress);

/// The table over all runs, for a terminal.
std::string sweep_text(const validate::SweepSummary& summary);

/// The same as one JSON object.
std::string sweep_json(const validate::SweepSummary& summary);

}  // namespace glidelab::report
