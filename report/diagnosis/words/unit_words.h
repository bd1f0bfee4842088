/// What has to be checked before a diagnosis can be trusted: a unit of lengths or times that may be wrong, or a scale.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// Of the clips whose positions are unusually far apart, in space or in time (core/check/motion_look.h), or that fall
/// faster than gravity, the first; empty if none is, and for a table of lines.
std::string unit_words(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
