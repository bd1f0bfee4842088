/// How a bandwidth, or the strength of a smoother, was chosen (core/result/strength_choice.h), in one line.
#pragma once

#include <string>

#include "core/result/results.h"

namespace glidelab::report {

/// Empty if the choice is not stated.
std::string strength_words(const core::StrengthChoice& choice);

}  // namespace glidelab::report
