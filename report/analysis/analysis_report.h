/// report.html of `analyze`: one page that needs nothing but itself.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "core/analysis/preview.h"
#include "core/result/results.h"
#include "report/html/html.h"

namespace glidelab::report {

/// `title` names what was analysed; `previews` is empty or has one for each clip of the results. EnvironmentError
/// where gnuplot fails.
Page analysis_report(const std::string& title, const core::AnalysisResults& results,
                     const std::vector<core::Preview>& previews, const base::Progress& progress = base::no_progress);

}  // namespace glidelab::report
