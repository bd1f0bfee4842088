/// How likely each explanation is when weighed with a remainder: by its evidence, and by the part of the gap that
/// it leaves.
///
/// The model of the remainder (remainder.h) is wrong as well: draughts, wavy tracks and lagging trackers are not a
/// white acceleration, and a difference of 50 in log evidence between two explanations is no certainty. The evidence of
/// a wrong model should be tempered (Grünwald and van Ommen, Bayesian Analysis 12, 1069, 2017). Here long tails temper
/// it. With d the log evidence by which an explanation falls short of the best one, and r the part of the held-out
/// excess that it leaves,
///
///     log odds = -n log(1 + d/s) + (a + c log E - b r where it names a cause)
///
/// where E is the excess of the nominal model, limited to 0.1 to 10 in this formula. A constant is subtracted for a
/// function without a name beside the explanation, for a hand that lets go late and for clips that scatter, since these
/// adapt to each clip. Clips that scatter have at least the
/// evidence of the nominal model, whose remainder contains the same scatter, and beside a cause that stated
/// inclinations show that of this cause; beside others this would count scatter once for each of them. A function
/// without a name that stands alone is weighed by what it leaves, like a cause, less a constant of its own because it
/// can be almost anything; if it leaves nearly all of the excess, only its evidence counts. The terms reflect that
/// small imperfections seldom make more than three tenths of an excess, that a wrong cause seldom leaves as little as
/// the right one, and that a large excess seldom comes from small imperfections alone. The constants make the true
/// causes of simulated experiments likeliest (blind --everyday); docs/evidence/blind-everyday.md says how they were
/// found, and how well they hold on other experiments.
///
/// In a fall through air the drag of air takes nearly all of the excess of a fall without drag, so that r would not
/// tell what a further cause does. It counts in two steps there: the drag by what it leaves of a fall without drag, and
/// the further causes by how much of the drag's own remainder they leave, each with the terms above.
///
/// A cause that is known by stated inclinations (Comparison::by_stated), such as a wrong scale, leaves the gap as it
/// is. Only its evidence counts, and r is for what acts beside it.
///
/// The scatter of single positions makes no gap. Explanations that differ only in such scatter are one explanation of
/// the gap. Its odds are those of the one without scatter, however strong the evidence of the scatter; they share its
/// probability by their evidence.
///
/// No data can tell a cause that is not on the list from one on the list that acts alike in them. The prior odds of
/// something without a name are 0.2 to 0.5 for one or two named causes (hypotheses.cpp). If a fifth of nameless causes
/// imitate a named one, 0.08 of the probability of every named cause belongs to something without a name.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// The excess above which the noise is negligible, if every explanation leaves more than kNearNoise. The evidence of
/// any curve is a certainty there, so only what an explanation leaves counts, less a log odds of 2 for each further
/// cause. What is left spans decades there: its root counts as well.
inline constexpr double kLargestExcess = 1e6;
inline constexpr double kNearNoise = 1e5;  ///< a gap of some 300 times the noise

/// What explanations leave of the held-out excess g² - 1.
struct LeftExcess {
  std::vector<double> of_fits;  ///< of the comparison's fits, the nominal one first; NaN where it was not measured
  double of_unnamed = 0.0;      ///< of the likeliest function without a name alone
  /// Of a fall through air without any drag. An explanation in which a quadratic drag takes the place of K leaves a
  /// part of this one; all others, and all where there is none, leave a part of the nominal model's.
  std::optional<double> without_drag = {};
};

/// Whether the noise is negligible for these excesses of the nominal model and of explanations. NaN was not measured.
bool noise_is_negligible(const std::vector<double>& excess);

/// Sets the probability of each hypothesis, of `none` and `unknown` and of each effect, and the part of the excess that
/// each hypothesis leaves (`left`). Hypotheses are then in order of falling probability. A function without a name
/// beside named causes counts towards these causes. Scatter of single positions alone counts towards `none`, because it
/// makes no gap.
void weigh_beside_remainder(const LeftExcess& excess, Comparison& comparison);

}  // namespace glidelab::diagnose
