/// diagnosis.json.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// The document, with a newline at its end. No number in it is NaN.
std::string diagnosis_json(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
