/// report.html of `analyze`: one self-contained page, which begins with the meaning of its numbers in words.
#pragma once

#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/analysis/preview.h"
#include "core/result/results.h"
#include "report/html/html.h"

namespace glidelab::report {

/// The friction that was found: how large it is, how well a straight line describes it, what is not determined. If the
/// law is in doubt, that comes first and the numbers are presented only as the result of a fit. HTML.
std::string meaning_of(const core::AnalysisResults& results);

/// `title` names what was analysed; `previews` is empty or has one for each clip of the results; `with_causes` is a
/// section on a fit with causes in the model, placed after the recovered values. EnvironmentError if gnuplot fails.
Page analysis_report(const std::string& title, const core::AnalysisResults& results,
                     const std::vector<core::Preview>& previews, const base::Progress& progress = base::no_progress,
                     const Html& with_causes = {});

/// For each configuration: K/m, mu, alpha, v_lim with sd, R² of its lines; below, the reasons for missing values.
std::string analysis_text(const core::AnalysisResults& results);

}  // namespace glidelab::report
