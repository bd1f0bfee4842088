/// The results of `require`: the cameras that reach a target, cheapest first, and what limits the others.
#pragma once

#include <string>

#include "report/html/html.h"
#include "validate/study/requirement/requirement.h"

namespace glidelab::report {

/// EnvironmentError if gnuplot fails.
Page requirement_report(const validate::Requirement& requirement);

/// The tables for a terminal.
std::string requirement_text(const validate::Requirement& requirement);

/// The same as one JSON object, with a newline at its end. No number in it is NaN.
std::string requirement_json(const validate::Requirement& requirement);

}  // namespace glidelab::report
