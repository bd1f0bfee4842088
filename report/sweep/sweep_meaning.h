/// The outcome of a sweep in words, a short paragraph at the head of its page, and which bandwidth rule errs least.
#pragma once

#include <string>

#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// A rule counts only where it answers in this part of the most often answered runs.
inline constexpr double kLeastAnsweredShare = 0.98;
/// "Better" is by more than this factor in rms error, and than two standard errors of it.
inline constexpr double kClearlyBetterFactor = 1.1;

/// The outcome of a sweep over bandwidth rules, in a paragraph: which rule has the least error of which quantity, by
/// what factor the default loses, and where another rule does better. HTML; empty if the sweep has no lines by more
/// than one rule.
std::string sweep_advice(const validate::SweepSummary& summary);

/// A stated standard deviation that is off by more than this factor (and two standard errors more) is named.
inline constexpr double kAstray = 2.0;

/// The outcome of a sweep, in a short paragraph. HTML. Who has the least rms error of each quantity (of those that
/// answer in kLeastAnsweredShare of the most often answered runs), how it changes along each key and from one
/// configuration to the other, whose 95 % intervals do not hold the truth as often (by more than three binomial
/// standard errors), and whose stated standard deviation is off the rms error by more than kAstray, either way. Empty
/// if no run has an answer.
std::string sweep_meaning(const validate::SweepSummary& summary);

}  // namespace glidelab::report
