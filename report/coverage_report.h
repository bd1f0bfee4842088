/// coverage.json, its table for a terminal, and its page.
#pragma once

#include <string>

#include "report/html.h"
#include "validate/coverage.h"

namespace glidelab::report {

std::string coverage_json(const validate::Coverage& coverage);
std::string coverage_text(const validate::Coverage& coverage);
Page coverage_page(const std::string& title, const validate::Coverage& coverage);

}  // namespace glidelab::report
