/// diagnosis.json, and of it what results.json has as well if causes are in the model.
#pragma once

#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// The document, with a newline at its end. No number in it is NaN.
std::string diagnosis_json(const diagnose::Diagnosis& diagnosis);

/// {"c_kg_m": {"value", "sd"}}; a word has no sd, and a value that the data do not determine is null with the reason.
Json parameters_json(const std::vector<diagnose::DiagnosedParameter>& parameters);

/// For each configuration: group, mass, inclination, the causes in the model, and the four quantities.
Json recovered_json(const std::vector<diagnose::RecoveredConfiguration>& recovered);

}  // namespace glidelab::report
