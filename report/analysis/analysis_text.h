/// What `analyze` prints on a terminal.
#pragma once

#include <string>

#include "core/result/results.h"

namespace glidelab::report {

/// Of each configuration: K/m, mu, alpha, v_lim with sd, R² of its lines; below, why something is missing.
std::string analysis_text(const core::AnalysisResults& results);

}  // namespace glidelab::report
