/// report.html of `analyze`: one self-contained page.
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

/// Of each configuration: K/m, mu, alpha, v_lim with sd, R² of its lines; below, why something is missing.
std::string analysis_text(const core::AnalysisResults& results);

}  // namespace glidelab::report
