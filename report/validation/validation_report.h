/// report.html of `validate`: truth, recovered value and error first, then all that an analysis shows.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "core/analysis/preview.h"
#include "core/result/results.h"
#include "report/html/html.h"
#include "validate/truth/comparison.h"

namespace glidelab::report {

/// `previews` is empty or has one for each clip of the results. EnvironmentError where gnuplot fails.
Page validation_report(const std::string& title, const core::AnalysisResults& results,
                       const validate::Comparison& comparison, const std::vector<core::Preview>& previews,
                       const base::Progress& progress = base::no_progress);

}  // namespace glidelab::report
