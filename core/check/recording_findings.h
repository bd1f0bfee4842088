/// What the measurements of a check say about a recording: pattern, marker, light, times. Contradictions between
/// experiment.toml and the recording are in statement_findings.h. docs/reference/check.md explains the limits.
#pragma once

#include <vector>

#include "core/check/recording_check.h"
#include "core/experiment/experiment.h"

namespace glidelab::core {

/// The most severe first; what several clips have in common is stated once.
std::vector<Finding> findings_of(const Experiment& experiment, const RecordingCheck& check);

}  // namespace glidelab::core
