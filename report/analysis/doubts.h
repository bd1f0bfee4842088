/// Whether the assumed law (drag in proportion to the speed, dry friction, gravity) fits what was analysed. Where it
/// does not, the standard deviations of K/m, µ, α and the terminal velocity say nothing of how far these are from the
/// glider's.
#pragma once

#include <string>
#include <vector>

#include "core/result/results.h"

namespace glidelab::report {

/// Results that the assumed law cannot explain (drag or friction below zero, points far off their line, positions far
/// off the fitted motion), and what to do next. One sentence each, plain text; none if the law fits.
std::vector<std::string> doubts_about(const core::AnalysisResults& results);

inline constexpr double kBelowZero = 2.0;  ///< standard deviations: what chance does in one of forty

/// Below a table of values that are in doubt.
inline constexpr const char* kIfItHeld = "The law does not fit these clips: the ± would hold only if it did.";

}  // namespace glidelab::report
