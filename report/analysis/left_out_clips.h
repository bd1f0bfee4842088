/// The clips of an experiment that the results do not contain, because their marker was not found.
#pragma once

#include <string>
#include <vector>

#include "core/result/results.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// What comes before all results, one sentence or clip each, plain text: how many clips are left out, which and why,
/// and a warning where fewer than half are left. None if there are no such clips.
std::vector<std::string> left_out_words(const std::vector<core::LeftOutClip>& clips);

/// The same as lines of text with an empty one behind them, and as HTML; empty if there are no such clips.
std::string left_out_text(const std::vector<core::LeftOutClip>& clips);
std::string left_out_html(const std::vector<core::LeftOutClip>& clips);

/// An array of {"clip", "experiment", "why"}.
Json left_out_json(const std::vector<core::LeftOutClip>& clips);

}  // namespace glidelab::report
