/// Intervals of a gap as a person reads them.
#pragma once

#include <optional>
#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// "22.1 to 28"; "–" where there is none.
std::string interval_text(const std::optional<diagnose::GapInterval>& interval);

/// How much of what is above the floor goes: "96.9 % (95.8 to 98.0 %)"; "" where the gap is at the floor.
std::string shrink_text(const diagnose::GapSizes& gap);

}  // namespace glidelab::report
