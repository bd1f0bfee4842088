/// The outcome of a sweep over bandwidth rules, in a paragraph: which rule has the least error of which quantity, by
/// what factor the default loses, and where another rule does better.
#pragma once

#include <string>

#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// A rule counts only where it answers in this part of the most often answered runs.
inline constexpr double kLeastAnsweredShare = 0.98;
/// "Better" is by more than this factor in rms error, and than two standard errors of it.
inline constexpr double kClearlyBetterFactor = 1.1;

/// HTML; empty if the sweep has no lines by more than one rule.
std::string sweep_advice(const validate::SweepSummary& summary);

}  // namespace glidelab::report
