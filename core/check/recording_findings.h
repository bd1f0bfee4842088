/// What the measurements of a check say about a recording: pattern, marker, light, times. Contradictions between
/// experiment.toml and the recording are in statement_findings.h. docs/reference/check.md explains the limits.
#pragma once

#include <string>
#include <vector>

#include "core/check/check_result.h"
#include "core/experiment/experiment.h"

namespace glidelab::core {

/// The most severe first; what several clips have in common is stated once.
std::vector<Finding> findings_of(const Experiment& experiment, const RecordingCheck& check);

/// Statements in a wrong unit, found from their size and from what the motion says: the one cause behind many findings.
///
/// A square, a marker, a track and a mass each have a usual size in a laboratory; one that is a hundred or a thousand
/// times as large is in centimetres, millimetres or grams. An inclination that agrees with the motion once it is taken
/// as radians is in radians, and one that agrees once the file's frame rate is taken has a wrong frame_rate_hz.
/// docs/reference/check.md explains the limits.
///
/// "square_m = 40 looks like millimetres (0.04 m)", and the advice; from the statements alone. `longest_m`: the longest
/// distance that a clip covers, 0 if it is not known; beyond 20 m, which no glider covers, any mass is accepted.
std::vector<Finding> unit_findings(const Experiment& experiment, double longest_m);

/// Whether a length is stated in a wrong unit, so that no marker of the stated size can be found.
bool explains_failures(const Experiment& experiment);

/// The findings with each root cause in place of those that follow from it, which move into its `follow`.
std::vector<Finding> with_root_causes(const Experiment& experiment, const RecordingCheck& check,
                                      std::vector<Finding> findings);

}  // namespace glidelab::core
