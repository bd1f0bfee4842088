/// check.json: what `glidelab check` found (docs/check.md).
#pragma once

#include <string>

#include "core/recording_check.h"

namespace glidelab::report {

std::string check_json(const core::RecordingCheck& check);

/// "note", "change" or "unusable".
std::string name_of(core::Severity severity);

}  // namespace glidelab::report
