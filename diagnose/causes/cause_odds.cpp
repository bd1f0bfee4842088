#include "diagnose/causes/cause_odds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr double kTail = 5.0, kPower = 2.45;                   // s and n
constexpr double kNamed = 1.1, kLeft = 12.5, kLarger = 0.8;    // a, b and c
constexpr double kLate = 3.2, kScatter = 1.8, kUnnamed = 1.4;  // log odds against
constexpr double kAnything = 1.0;                         // log odds against a function without a name, of anything
constexpr double kFurther = 2.0;                          // log odds against a further cause, without noise
constexpr double kNotMeasured = -1.0;                     // a gap of nothing: no clip was held out
constexpr double kLeastExcess = 0.1, kMostExcess = 10.0;  // between which a larger excess speaks for a cause

bool names(const Hypothesis& hypothesis, std::size_t effect) {
  return std::find(hypothesis.effects.begin(), hypothesis.effects.end(), effect) != hypothesis.effects.end();
}

bool makes_a_gap(const Hypothesis& hypothesis) {
  return std::any_of(hypothesis.effects.begin(), hypothesis.effects.end(),
                     [](std::size_t e) { return takes_part_of_gap(effect_list()[e].search); });
}

/// Friction and drag of each clip are what the remainder of the nominal model has too: as much evidence as nothing.
bool is_clip_scatter(const Hypothesis& hypothesis) {
  return hypothesis.effects == std::vector<std::size_t>{effect_index(ids::clip_scatter)};
}

double part_left(double left, double before) {
  if (!(before > kLeastExcess) || !(left > kNotMeasured)) return 1.0;
  return std::clamp(left / before, 0.0, 1.0);
}

}  // namespace

void weigh_by_share_left(const std::vector<double>& excess, double unnamed_excess, Comparison& comparison) {
  double best = comparison.all.front().log_evidence;
  for (const Hypothesis& one : comparison.all) best = std::max(best, one.log_evidence);
  const double named = kNamed + kLarger * std::log(std::clamp(excess.front(), kLeastExcess, kMostExcess));
  std::vector<double> logs;
  for (const Hypothesis& one : comparison.all) {
    const double evidence = is_clip_scatter(one) ? std::max(one.log_evidence, 0.0) : one.log_evidence;
    double log = -kPower * std::log1p((best - evidence) / kTail);
    if (excess.front() > kLargestExcess) log = -kFurther * std::max(0.0, static_cast<double>(one.effects.size()) - 1.0);
    if (makes_a_gap(one)) {
      const double left = one.fit > 0 ? excess[static_cast<std::size_t>(one.fit)] : excess.front();
      log += named - kLeft * part_left(left, excess.front());
    }
    if (one.unnamed && one.effects.empty()) {
      log += std::max(0.0, named - kAnything - kLeft * part_left(unnamed_excess, excess.front()));
    }
    if (names(one, effect_index(ids::late_release))) log -= kLate;
    if (names(one, effect_index(ids::clip_scatter))) log -= kScatter;
    if (names(one, effect_index(ids::power_law_drag))) log += std::log(kAnyPower);
    if (one.unnamed) log -= kUnnamed;
    logs.push_back(log);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double& log : logs) sum += log = std::exp(log - most);
  for (std::size_t h = 0; h < logs.size(); ++h) comparison.all[h].probability = logs[h] / sum;
  // What is beside a cause counts for the cause, and scatter of single positions alone for nothing: it makes no gap.
  for (Hypothesis& from : comparison.all) {
    const bool scatter_alone = is_scatter_alone(from);
    if (!scatter_alone && (!from.unnamed || from.effects.empty())) continue;
    for (Hypothesis& pure : comparison.all) {
      if (pure.unnamed || (scatter_alone ? !pure.effects.empty() : pure.effects != from.effects)) continue;
      pure.probability += std::exchange(from.probability, 0.0);
    }
  }
  set_probabilities(comparison);
}

}  // namespace glidelab::diagnose
