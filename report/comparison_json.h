/// comparison.json: each recovered value beside its truth.
#pragma once

#include <string>

#include "validate/comparison.h"

namespace glidelab::report {

std::string comparison_json(const validate::Comparison& comparison);

}  // namespace glidelab::report
