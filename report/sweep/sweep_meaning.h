/// The outcome of a sweep, in a short paragraph at the head of its page.
#pragma once

#include <string>

#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// A stated standard deviation that is off by more than this factor (and two standard errors more) is named.
inline constexpr double kAstray = 2.0;

/// HTML. Who has the least rms error of each quantity (of those that answer in kLeastAnsweredShare of the most often
/// answered runs, sweep_advice.h), how it changes along each key and from one configuration to the other, whose 95 %
/// intervals do not hold the truth as often (by more than three binomial standard errors), and whose stated
/// standard deviation is off the rms error by more than kAstray, either way. Empty if no run has an answer.
std::string sweep_meaning(const validate::SweepSummary& summary);

}  // namespace glidelab::report
