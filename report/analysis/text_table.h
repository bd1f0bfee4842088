/// Tables for a terminal.
#pragma once

#include <string>
#include <vector>

#include "core/result/results.h"
#include "validate/truth/comparison.h"

namespace glidelab::report {

/// Columns set under their headers, two spaces apart; columns from `first_number` on are flush right. Widths count
/// characters, not bytes; control characters become "?", for a clip's name must not steer the terminal.
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t first_number);

/// Of each configuration: K/m, mu, alpha, v_lim with sd, R² of its lines; below, why something is missing.
std::string analysis_text(const core::AnalysisResults& results);

/// Of each configuration: truth, recovered value, sd and error; R² of each clip's lines; restitution, frames, time.
std::string comparison_text(const validate::Comparison& comparison);

}  // namespace glidelab::report
