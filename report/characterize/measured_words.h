/// How a number of a measured camera was found, or why there is none (core/characterize/measured.h), in words.
#pragma once

#include <string>

#include "core/characterize/measured.h"

namespace glidelab::report {

/// "from the dark frames"; empty if there is only one way.
std::string how_words(const core::Measured& measured);

/// "hidden by the quantisation: less than 0.31 e-"; empty if there is a value.
std::string why_words(const core::Measured& measured);

}  // namespace glidelab::report
