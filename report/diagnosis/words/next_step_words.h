/// What to record next (diagnose/result/next_step.h) as a sentence or two.
#pragma once

#include <string>

#include "diagnose/result/next_step.h"

namespace glidelab::report {

/// Empty if no step was searched for.
std::string next_step_words(const diagnose::NextStep& step);

}  // namespace glidelab::report
