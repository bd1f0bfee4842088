/// What a sweep over bandwidth rules comes to, in a paragraph: which rule has the least error of which quantity, by
/// what factor the default loses, and where another rule does better.
#pragma once

#include <string>

#include "validate/sweep_summary.h"

namespace glidelab::report {

/// HTML; empty where the sweep has no lines by more than one rule. A rule counts only where it answers nearly as often
/// as any (kAnswers of the most); "better" is by more than kBetter in rms error, and
/// than two standard errors of that.
inline constexpr double kAnswers = 0.98;
inline constexpr double kBetter = 1.1;
std::string sweep_advice(const validate::SweepSummary& summary);

}  // namespace glidelab::report
