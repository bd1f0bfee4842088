/// The result of a fit with causes in the model, in the form common to the JSON files of `diagnose` and `analyze`.
#pragma once

#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// {"c_kg_m": {"value", "sd"}}; a word has no sd, and a value that the data do not determine is null with the reason.
Json parameters_json(const std::vector<diagnose::DiagnosedParameter>& parameters);

/// For each configuration: group, mass, inclination, the causes in the model, and the four quantities.
Json recovered_json(const std::vector<diagnose::RecoveredConfiguration>& recovered);

}  // namespace glidelab::report
