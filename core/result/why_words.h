/// Why the data do not determine a quantity (why_unknown.h), in words. They are here and not in report/, because
/// validate/ stores them in a sweep's database.
#pragma once

#include <optional>
#include <string>

#include "core/result/analysis_note.h"
#include "core/result/why_unknown.h"

namespace glidelab::core {

/// "no line for v > 0"; empty without a reason.
std::string why_words(const std::optional<WhyUnknown>& why);

/// "motion towards +x before 0.542 s is attributed to the hand and excluded, since the launch was towards -x"
std::string launch_words(const AgainstLaunch& against);

}  // namespace glidelab::core
