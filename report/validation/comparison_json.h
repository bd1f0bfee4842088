/// comparison.json: each recovered value beside its truth.
#pragma once

#include <string>

#include "validate/truth/comparison.h"

namespace glidelab::report {

/// The document, with a newline at its end. No number in it is NaN; what is missing is null with its reason in "why".
std::string comparison_json(const validate::Comparison& comparison);

}  // namespace glidelab::report
