/// A diagnosis for a terminal.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// Summary, ranking, gap, what to record next, notes.
std::string diagnosis_text(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
