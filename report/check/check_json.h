/// check.json: what `glidelab check` found (docs/reference/check.md).
#pragma once

#include <string>

#include "core/check/recording_check.h"

namespace glidelab::report {

/// The document, with a newline at its end. No number in it is NaN; what is missing is null with its reason in "why".
std::string check_json(const core::RecordingCheck& check);

/// "note", "change" or "unusable".
std::string name_of(core::Severity severity);

}  // namespace glidelab::report
