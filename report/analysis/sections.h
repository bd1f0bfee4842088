/// The sections shared by the pages of an analysis and of a validation.
#pragma once

#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/analysis/preview.h"
#include "core/result/results.h"
#include "report/html/html.h"

namespace glidelab::report {

/// One row per configuration: the recovered values, and below the table the reasons for missing ones.
std::string recovered_section(const core::AnalysisResults& results);

/// "µ and α are not determined: …" for each reason why quantities of this configuration are missing.
std::vector<std::string> undetermined_words(const core::ConfigurationResult& configuration);

/// The phase diagrams of every set-up.
Html phase_section(const core::AnalysisResults& results);

/// The details behind the values: the fitted lines (as the paper's tables 1 and 3), calibration and plumb line if
/// present, every clip (facts, plots, images, omitted points with reasons, notes), and the method in a few sentences.
/// `previews` is empty or has one for each clip.
Html details_sections(const core::AnalysisResults& results, const std::vector<core::Preview>& previews,
                      const base::Progress& progress);

}  // namespace glidelab::report
