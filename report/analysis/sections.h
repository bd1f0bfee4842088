/// The parts that the pages of an analysis and of a validation share.
#pragma once

#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/analysis/preview.h"
#include "core/result/results.h"
#include "report/html/html.h"

namespace glidelab::report {

/// One row a configuration: what was recovered, and below it why something was not.
std::string recovered_section(const core::AnalysisResults& results);

/// The phase diagrams of every set-up.
Html phase_section(const core::AnalysisResults& results);

/// The details behind the values: the fitted lines (as the paper's tables 1 and 3), calibration and plumb line where
/// there are any, every clip (facts, plots, images, what was left out and why, notes), and the method in a few
/// sentences. `previews` is empty or has one for each clip.
Html details_sections(const core::AnalysisResults& results, const std::vector<core::Preview>& previews,
                      const base::Progress& progress);

}  // namespace glidelab::report
