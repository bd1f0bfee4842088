/// What has to be checked before a diagnosis can be trusted: a unit of lengths or times that may be wrong, a scale, or
/// a path that is not straight.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// Of the clips that make a unit or the scale doubtful, the first; otherwise of those whose path turns by three degrees
/// or more. Empty if there are none.
std::string unit_words(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
