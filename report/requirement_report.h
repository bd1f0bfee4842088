/// What `require` says: the cameras that reach a target, cheapest first, and what limits the others.
#pragma once

#include <string>

#include "report/html.h"
#include "validate/requirement.h"

namespace glidelab::report {

/// EnvironmentError where gnuplot fails.
Page requirement_report(const validate::Requirement& requirement);
std::string requirement_text(const validate::Requirement& requirement);
std::string requirement_json(const validate::Requirement& requirement);

}  // namespace glidelab::report
