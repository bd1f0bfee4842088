/// A short paragraph in words on what the numbers say.
#pragma once

#include <string>

#include "core/results.h"
#include "validate/comparison.h"

namespace glidelab::report {

/// On the friction that was found: how large, how well a straight line describes it, what is not determined. HTML.
std::string meaning_of(const core::AnalysisResults& results);

/// On how well the truth was recovered. HTML.
std::string meaning_of(const validate::Comparison& comparison);

}  // namespace glidelab::report
