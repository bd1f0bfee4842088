#include "diagnose/verdict/probabilities_by_share.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math/log_sum.h"
#include "diagnose/causes/cause_odds.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

void sort_by_probability(Comparison& comparison) {
  std::stable_sort(comparison.all.begin(), comparison.all.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
}

/// The probability of an effect is the sum over the explanations that contain it.
void sum_of_effects(Comparison& comparison) {
  std::fill(comparison.effect_probability.begin(), comparison.effect_probability.end(), 0.0);
  for (const Hypothesis& one : comparison.all) {
    if (one.unnamed) continue;
    for (const std::size_t e : one.effects) comparison.effect_probability[e] += one.probability;
  }
}

/// Gives the explanations with `main` a total probability of kProbabilityByShare, and everything else the rest.
void trust(std::size_t main, const std::vector<std::size_t>& best, Comparison& comparison) {
  double with_main = 0.0, rest = comparison.unknown;
  for (const Hypothesis& one : comparison.all) {
    if (!one.unnamed) (has(one, main) ? with_main : rest) += one.probability;
  }
  // They may have lost all of their probability to the unknown. The best explanation then stands for them.
  const bool lost = !(with_main > 0.0);
  for (Hypothesis& one : comparison.all) {
    if (lost && !one.unnamed && one.effects == best) {
      one.probability = kProbabilityByShare;
    } else {
      one.probability *= !one.unnamed && has(one, main) && !lost ? kProbabilityByShare / with_main
                                                                 : (1.0 - kProbabilityByShare) / rest;
    }
  }
  comparison.unknown *= (1.0 - kProbabilityByShare) / rest;
  sum_of_effects(comparison);
  sort_by_probability(comparison);
}

}  // namespace

bool may_displace(const CauseSequence& likelier, const CauseSequence& named) {
  return likelier.named_share >= kHalfOfGap || named.named_share < kHalfOfGap;
}

bool needs_no_share(const CauseSequence& sequence, const Hypothesis& named, const Comparison& comparison) {
  const bool by_stated = std::any_of(named.effects.begin(), named.effects.end(),
                                     [&](std::size_t e) { return comparison.by_stated.contains(e); });
  return by_stated && !shows_in_gap(named, comparison.by_stated) &&
         sequence.gap_before * sequence.gap_before - 1.0 < 1.0;
}

bool may_take_nothing(const CauseSequence& sequence) {
  if (sequence.causes.empty() || sequence.gap_before * sequence.gap_before - 1.0 >= 1.0) return false;
  const auto& interval = sequence.causes.front().share_interval95;
  return interval && interval->low <= 0.0;
}

double probability_of_scatter(const Comparison& comparison) {
  double sum = 0.0;
  for (const Hypothesis& one : comparison.all) sum += is_scatter_alone(one) ? one.probability : 0.0;
  return sum;
}

void move_to_none(const std::function<bool(const Hypothesis&)>& of, Comparison& comparison) {
  for (Hypothesis& one : comparison.all) {
    if (one.unnamed || one.effects.empty() || !of(one)) continue;
    comparison.none += one.probability;
    for (const std::size_t e : one.effects) comparison.effect_probability[e] -= one.probability;
    one.probability = 0.0;
  }
}

void keep_drag_of_air(Comparison& comparison) {
  const auto is_kept = [](const Hypothesis& one) {
    return !one.unnamed && (one.effects.empty() || has(one, effect_index(ids::quadratic_drag)));
  };
  double kept = 0.0;
  for (const Hypothesis& one : comparison.all) kept += is_kept(one) ? one.probability : 0.0;
  if (!(kept > 0.0)) return;
  for (Hypothesis& one : comparison.all) one.probability = is_kept(one) ? one.probability / kept : 0.0;
  set_probabilities(comparison);
}

void set_unknown(double unknown, Comparison& comparison) {
  const double before = 1.0 - comparison.unknown;
  const double factor = before > 0.0 ? (1.0 - unknown) / before : 0.0;
  for (Hypothesis& one : comparison.all) {
    if (!one.unnamed) one.probability *= factor;
  }
  for (double& probability : comparison.effect_probability) probability *= factor;
  comparison.none *= factor;
  comparison.unknown = unknown;
}

bool trust_stated(Comparison& comparison) {
  constexpr double kWrongStatement = 0.1;
  const MotionFit& nominal = comparison.fits.front();
  std::vector<double> logs;
  std::vector<Hypothesis*> resolving;
  for (Hypothesis& one : comparison.all) {
    if (one.unnamed || one.effects.size() != 1 || one.fit <= 0) continue;
    const MotionFit& fit = comparison.fits[static_cast<std::size_t>(one.fit)];
    if (gain_in_stated(nominal, fit) < kClearInStated || !(chi2_of_stated(fit) < kClearInStated)) continue;
    resolving.push_back(&one);
    logs.push_back(one.log_evidence + log_prior_odds(comparison, one));
  }
  if (resolving.empty()) return false;
  const double unknown = std::exchange(comparison.unknown, kWrongStatement);
  for (Hypothesis& one : comparison.all) {
    one.probability *= one.unnamed && unknown > 0.0 ? kWrongStatement / unknown : 0.0;
  }
  comparison.none = 0.0;
  const double all = base::log_sum(logs);
  for (std::size_t k = 0; k < resolving.size(); ++k) {
    resolving[k]->probability = (1.0 - kWrongStatement) * std::exp(logs[k] - all);
  }
  sum_of_effects(comparison);
  sort_by_probability(comparison);
  return true;
}

void move_minorities_to_unknown(Comparison& comparison) {
  for (Hypothesis& one : comparison.all) {
    if (one.unnamed || !shows_in_gap(one, comparison.by_stated) || one.left.value_or(0.0) <= 1.0 - kHalfOfGap) continue;
    std::set<std::size_t> kept(one.effects.begin(), one.effects.end());
    std::erase_if(kept, [&](std::size_t e) { return !comparison.by_stated.contains(e); });
    const Hypothesis* stated = kept.empty() ? nullptr : find(comparison, kept);
    for (const std::size_t e : one.effects) {
      if (stated == nullptr || !kept.contains(e)) comparison.effect_probability[e] -= one.probability;
    }
    const double moved = std::exchange(one.probability, 0.0);
    if (stated == nullptr) {
      comparison.unknown += moved;
    } else {
      comparison.all[static_cast<std::size_t>(stated - comparison.all.data())].probability += moved;
    }
  }
  sort_by_probability(comparison);
}

void hold_to_share(const CauseSequence& sequence, const std::vector<std::size_t>& best, bool by_air,
                   Comparison& comparison) {
  comparison.unknown += std::exchange(comparison.none, 0.0);
  const Hypothesis of{best};
  if (sequence.named_share < kHalfOfGap && shows_in_gap(of) && !needs_no_share(sequence, of, comparison)) {
    // The probability of explanations that leave more than half is unknown already; now that of the best one is as
    // well.
    double of_best = 0.0;
    for (const Hypothesis& one : comparison.all) {
      if (!one.unnamed && one.effects == best) of_best += one.probability;
    }
    set_unknown(std::max(comparison.unknown + of_best, kUnknownIfLess), comparison);
  }
  if (sequence.named_share < kMostOfGap || comparison.unknown < 1.0 - kProbabilityByShare) return;
  const std::size_t main = effect_index(sequence.causes.front().id);
  // Where the noise is negligible, any curve has the evidence of a certainty, and only the share counts.
  // The gap of a fall without drag is no measure of the noise.
  const bool no_noise = !by_air && sequence.gap_before * sequence.gap_before - 1.0 >= kLargestExcess;
  if (no_noise && !follows_each_clip(main)) trust(main, best, comparison);
}

}  // namespace glidelab::diagnose
