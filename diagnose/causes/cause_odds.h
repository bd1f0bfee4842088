/// How likely each explanation is beside a remainder: by its evidence, and by what it leaves of the gap.
///
/// The model of the remainder (remainder.h) is not the truth either: draughts, wavy tracks and lagging trackers are not
/// a white acceleration, and a difference of 50 in log evidence between two explanations is not a certainty. The
/// evidence of a wrong model should be tempered (Grünwald and van Ommen, Bayesian Analysis 12, 1069, 2017); here by
/// long tails. With d the log evidence by which an explanation falls short of the best, and r the part of the held-out
/// excess that it leaves,
///
///     log odds = -n log(1 + d/s) + (a + c log E - b r where it names a cause)
///
/// E the excess before, between 0.1 and 10; less a constant for a function without a name beside it, for a hand that
/// lets go late and for clips that scatter, since these adapt to each clip. Scatter alone has at least the evidence of
/// nothing, whose remainder has the same scatter. A function without a name and without a cause is weighed like a cause
/// by what it leaves, less a constant of its own, because it can be almost anything; if it leaves nearly all, only its
/// evidence counts. Small imperfections seldom make more than three tenths of an excess, a wrong cause seldom leaves as
/// little as the right one, and a large excess seldom comes from small imperfections alone. The constants make the true
/// causes of made experiments likeliest (blind --everyday); docs/evidence/blind-everyday.md says how, and how well they
/// hold on others.
///
/// Scatter of single positions makes no gap. Explanations that differ in it alone are one explanation of the gap, with
/// the odds of that without any, however strong the evidence of the scatter; they share its probability by theirs.
///
/// No data can tell a cause off the list from one of the list that has the same law in them. With prior odds of 0.2 for
/// what has no name to 0.5 for what has one or two (hypotheses.cpp), and a fifth of it imitated, 0.08 of the
/// probability of every named cause is that of something without a name.
#pragma once

#include <vector>

#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// An excess above which the noise is negligible: the evidence of any curve is then a certainty, and only what an
/// explanation leaves counts, less 2 for each further cause.
inline constexpr double kLargestExcess = 1e6;

/// Sets the probabilities: of each hypothesis, `none`, `unknown` and of each effect; hypotheses are then in order of
/// falling probability. `excess` is of each of the comparison's fits, g² - 1, the nominal one first; NaN where it was
/// not measured; `unnamed_excess` is that of the likeliest function without a name beside nothing. A function without a
/// name beside named causes counts towards their names, scatter of single positions alone towards nothing, because it
/// makes no gap. Sets what each leaves of the excess (`left`).
void weigh_beside_remainder(const std::vector<double>& excess, double unnamed_excess, Comparison& comparison);

}  // namespace glidelab::diagnose
