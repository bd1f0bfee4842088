#include "diagnose/result/diagnosis.h"

#include <algorithm>
#include <utility>

namespace glidelab::diagnose {

bool is_at_floor(const Diagnosis& diagnosis) {
  constexpr double kMostErrorsAtFloor = 7.5;  // standard errors above the floor: no more is a gap at the floor
  return diagnosis.gap && diagnosis.gap->before < 1.0 + kMostErrorsAtFloor * diagnosis.gap->standard_error;
}

bool only_statements_fail(const Diagnosis& diagnosis) {
  return diagnosis.verdict == Verdict::unknown && is_at_floor(diagnosis) &&
         !(diagnosis.limits.driving.empty() && diagnosis.limits.contradicted.empty());
}

std::optional<FitsCutOff> fits_cut_off(const std::vector<RankedExplanation>& ranking) {
  constexpr double kLeast = 0.01;  // less likely ones change nothing that a reader sees
  FitsCutOff cut_off;
  for (const RankedExplanation& ranked : ranking) {
    if (!ranked.converged && ranked.probability >= kLeast) cut_off.of.push_back(ranked.explanation);
  }
  return cut_off.of.empty() ? std::nullopt : std::optional(std::move(cut_off));
}

namespace {

/// The probability that one of them acts; empty if no explanation contains any.
std::optional<double> any_of(const std::vector<NamedExplanation>& explanations, const std::vector<std::string>& ids) {
  std::optional<double> sum;
  for (const NamedExplanation& explanation : explanations) {
    const bool holds = std::any_of(ids.begin(), ids.end(), [&](const std::string& id) {
      return std::find(explanation.ids.begin(), explanation.ids.end(), id) != explanation.ids.end();
    });
    if (holds) sum = sum.value_or(0.0) + explanation.probability;
  }
  return sum;
}

}  // namespace

void join_alike(const std::vector<NamedExplanation>& explanations,
                const std::function<std::string(const std::string& id)>& words, Diagnosis& diagnosis) {
  for (DiagnosedEffect& effect : diagnosis.effects) {
    effect.joint_probability = effect.probability;
    effect.alike.clear();
    if (effect.equivalent_to.empty()) continue;
    std::vector<std::string> ids = {effect.id};
    ids.insert(ids.end(), effect.equivalent_to.begin(), effect.equivalent_to.end());
    effect.joint_probability = any_of(explanations, ids).value_or(effect.probability);
    for (const std::string& id : ids) effect.alike.push_back({id, words(id), any_of(explanations, {id})});
    std::stable_sort(effect.alike.begin(), effect.alike.end(), [](const AlikeEffect& a, const AlikeEffect& b) {
      return a.probability.value_or(0.0) > b.probability.value_or(0.0);
    });
  }
}

}  // namespace glidelab::diagnose
