/// What `validate` says of a comparison with the truth: on a terminal, and in words at the head of its page.
#pragma once

#include <string>

#include "validate/truth/comparison.h"

namespace glidelab::report {

/// First, of each configuration, K/m, mu and alpha by the better estimator beside their truth, and how many values
/// agree with it; then, below a line "In full:", every quantity, R² of each clip's lines, position error, frames and
/// time.
std::string comparison_text(const validate::Comparison& comparison);

/// On how well the truth was recovered. HTML.
std::string meaning_of(const validate::Comparison& comparison);

}  // namespace glidelab::report
