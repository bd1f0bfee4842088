/// Why the data do not determine a quantity, in words.
#pragma once

#include <optional>
#include <string>

#include "core/result/analysis_note.h"
#include "core/result/why_unknown.h"

namespace glidelab::report {

/// "no line for v > 0"; empty without a reason.
std::string why_words(const std::optional<core::WhyUnknown>& why);

/// "motion towards +x before 0.542 s is attributed to the hand and excluded, since the launch was towards -x"
std::string launch_words(const core::AgainstLaunch& against);

}  // namespace glidelab::report
