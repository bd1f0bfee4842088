/// Whether the assumed law (drag proportional to speed, dry friction, gravity) fits the analysed data. If it does not,
/// the standard deviations of K/m, µ, α and the terminal velocity do not tell how far these are from the glider's true
/// values.
#pragma once

#include <string>
#include <vector>

#include "core/result/results.h"

namespace glidelab::report {

/// Results that the assumed law cannot explain (drag or friction below zero, a line that begins above gravity or, in
/// a fall, far below it, points far from their line, positions far from the fitted motion), and what to do next. One
/// sentence each, plain text; none if the law fits.
std::vector<std::string> doubts_about(const core::AnalysisResults& results);

/// Whether the body rests in every clip: the law is then not in doubt, and has no values.
bool nothing_moves(const core::AnalysisResults& results);

inline constexpr double kLeastDoubtSds = 2.0;  ///< standard deviations: happens by chance in one of forty

/// By kLeastDoubtSds, and with all of the 95 % interval: a standard deviation from two clips is itself hardly known.
bool is_below_zero(const core::Estimate& of);

/// Placed below a table of values that are in doubt.
inline constexpr const char* kIfItHeld = "The law does not fit these clips: the ± would hold only if it did.";

}  // namespace glidelab::report
