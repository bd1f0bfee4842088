/// The outcome of a sweep in words, a short paragraph at the top of its page, and which bandwidth rule has the smallest
/// error.
#pragma once

#include <string>

#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// A rule counts only if it answers in this fraction of the most often answered runs.
inline constexpr double kLeastAnsweredShare = 0.98;
/// "Better" means by more than this factor in rms error, and by more than two standard errors of it.
inline constexpr double kClearlyBetterFactor = 1.1;

/// The outcome of a sweep over bandwidth rules, in a paragraph: which rule has the smallest error for which quantity,
/// by what factor the default is worse, and where another rule does better. HTML; empty if the sweep has no lines by
/// more than one rule.
std::string sweep_advice(const validate::SweepSummary& summary);

/// A scatter of more than this many stated standard deviations is named, and in a sweep one of less than their inverse
/// (and two standard errors more). Chance alone moves the ratio of 200 values by a tenth.
inline constexpr double kMostScatterOverStated = 2.0;

/// The outcome of a sweep, in a short paragraph. HTML. It names the estimator with the smallest rms error for each
/// quantity (of those that answer in kLeastAnsweredShare of the most often answered runs), how the error changes along
/// each key and from one configuration to another, whose 95 % intervals do not contain the truth as often (by more than
/// three binomial standard errors), and whose stated standard deviation differs from the rms error by more than
/// kMostScatterOverStated, in either direction. Empty if no run has an answer.
std::string sweep_meaning(const validate::SweepSummary& summary);

}  // namespace glidelab::report
