/// What `glidelab check` found, for people: a page, and text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "core/analysis/preview.h"
#include "core/check/recording_check.h"
#include "report/html/html.h"

namespace glidelab::report {

/// `previews` is empty or has one for each clip. EnvironmentError if gnuplot fails.
Page check_report(const core::RecordingCheck& check, const std::vector<core::Preview>& previews);

/// The findings with their advice, and a line for each clip.
std::string check_text(const core::RecordingCheck& check);

}  // namespace glidelab::report
