/// What has to be checked before a diagnosis can be trusted: a unit of lengths or times that may be wrong, or a scale.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// Of the clips that make a unit or the scale doubtful, the first; empty if none does.
std::string unit_words(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
