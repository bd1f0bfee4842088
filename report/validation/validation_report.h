/// report.html of `validate`: truth, recovered value and error first, then everything that an analysis shows; its plots
/// of truth against estimate, and comparison.json.
#pragma once

#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/analysis/preview.h"
#include "core/result/results.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "validate/truth/comparison.h"

namespace glidelab::report {

/// comparison.json: each recovered value with its truth, with a newline at its end. No number in it is NaN; a missing
/// value is null with its reason in "why".
std::string comparison_json(const validate::Comparison& comparison);

/// Truth against estimate: errors of the recovered values in units of their standard deviation, restitution errors of
/// the positions across the field, and errors of the centres within their pixels; each only if there is something to
/// compare.
std::vector<Plot> validation_plots(const core::AnalysisResults& results, const validate::Comparison& comparison);

/// `previews` is empty or has one for each clip of the results. EnvironmentError if gnuplot fails.
Page validation_report(const std::string& title, const core::AnalysisResults& results,
                       const validate::Comparison& comparison, const std::vector<core::Preview>& previews,
                       const base::Progress& progress = base::no_progress);

/// First how many values agree with the truth, and K/m, mu, alpha and v_lim of the middle mass by the better estimator;
/// then, below a line "In full:", every quantity of every configuration, R² of each clip's lines, position error,
/// frames and time.
std::string comparison_text(const validate::Comparison& comparison);

/// How well the truth was recovered. HTML.
std::string meaning_of(const validate::Comparison& comparison);

}  // namespace glidelab::report
