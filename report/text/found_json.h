/// What a fit with causes in the model found, as the JSON files of `diagnose` and `analyze` both have it.
#pragma once

#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// {"c_kg_m": {"value", "sd"}}; a word has no sd, and what the data do not tell is null with the reason.
Json parameters_json(const std::vector<diagnose::DiagnosedParameter>& parameters);

/// Of each configuration: group, mass, inclination, the causes in the model, and the four quantities.
Json recovered_json(const std::vector<diagnose::RecoveredConfiguration>& recovered);

}  // namespace glidelab::report
