/// The parts that the pages of an analysis and of a validation share.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "core/preview.h"
#include "core/results.h"

namespace glidelab::report {

/// "2.7791 ± 0.0062 1/s" as HTML, or a dash that says why on hover and in a footnote of the table.
std::string quantity_html(const core::Quantity& quantity, std::string_view unit);

/// One row a configuration: what was recovered, and below it why something was not.
std::string recovered_section(const core::AnalysisResults& results);

/// The phase diagrams of every set-up.
std::string phase_section(const core::AnalysisResults& results);

/// The fitted lines of every clip, as the paper's tables 1 and 3.
std::string lines_section(const core::AnalysisResults& results);

/// Every clip: facts, plots, pictures, what was left out and why, notes. `previews` is empty or has one for each clip.
std::string clips_section(const core::AnalysisResults& results, const std::vector<core::Preview>& previews,
                          const base::Progress& progress);

/// Calibration and plumb line; empty where there are neither.
std::string camera_section(const core::AnalysisResults& results);

/// The method in a few sentences, for who reads the page without the paper.
std::string method_section();

}  // namespace glidelab::report
