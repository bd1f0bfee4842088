/// The findings of `glidelab check`: check.json (docs/reference/check.md), a page, and text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "core/analysis/preview.h"
#include "core/check/check_result.h"
#include "report/html/html.h"

namespace glidelab::report {

/// The document, with a newline at its end. No number in it is NaN; what is missing is null with its reason in "why".
std::string check_json(const core::RecordingCheck& check);

/// "note", "change" or "unusable".
std::string name_of(core::Severity severity);

/// `previews` is empty or has one for each clip. EnvironmentError if gnuplot fails.
Page check_report(const core::RecordingCheck& check, const std::vector<core::Preview>& previews);

/// The findings with their advice, and a line for each clip.
std::string check_text(const core::RecordingCheck& check);

}  // namespace glidelab::report
