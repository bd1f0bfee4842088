/// What is said of a case whose true effect was taken from the list, and of where it lies.
#pragma once

#include <string>
#include <vector>

#include "validate/blind/blind_score.h"

namespace glidelab::validate {

/// "unknown", "none", "failed", "equivalent" (an equal of the truth on these data, as the full diagnosis says),
/// "another name", "another name, probability over 0.8". std::logic_error of a case that was not diagnosed without it.
std::string verdict_without(const BlindOutcome& outcome);

/// The variables over which an effect of the list can be seen to act (`where` of a diagnosis.json, "clip" for a region
/// of one clip), as effects.md has it; none of an effect that no region can show (an inclination alone, single frames).
std::vector<std::string> variables_of(const std::string& effect);

}  // namespace glidelab::validate
