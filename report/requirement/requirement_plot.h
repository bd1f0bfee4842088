/// The plot of a requirement: the accuracy of each candidate against its cost.
#pragma once

#include <string>

#include "report/html/plot.h"
#include "validate/study/requirement/requirement.h"

namespace glidelab::report {

/// By runs, or by the bound with room to spare.
bool reached(const validate::Candidate& candidate);

/// "rms error of α (10⁻³ °)"; `factor` precedes the unit.
std::string target_name(const validate::Target& target, const std::string& factor = {});

/// The first target's error with one standard deviation, against price or pixels per second; each point has its number
/// in the tables, and points close together share one label ("3-5, 8").
Plot requirement_plot(const validate::Requirement& requirement);

/// "1-3, 7" for rising numbers.
std::string ranges_text(const std::vector<int>& numbers);

}  // namespace glidelab::report
