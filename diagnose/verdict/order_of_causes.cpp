#include "diagnose/verdict/order_of_causes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/effects/effect_library.h"
#include "diagnose/verdict/probabilities_by_share.h"

namespace glidelab::diagnose {

std::vector<ExplainedCause> helpful(std::vector<ExplainedCause> causes) {
  double sum = 0.0;
  const auto first_too_many = std::find_if(causes.begin(), causes.end(), [&](const ExplainedCause& cause) {
    return !(cause.share > 0.0) || (sum += cause.share) >= kHalfOfGap;
  });
  causes.erase(first_too_many, causes.end());
  return causes;
}

GapRemainder remainder_of(double gap_before, const std::vector<ExplainedCause>& causes, const RemainderSizes& sizes,
                          double part_s) {
  GapRemainder remainder;
  for (const ExplainedCause& cause : causes) remainder.share -= cause.share;
  remainder.gap = causes.empty() ? gap_before : causes.back().gap_after;
  if (part_s > 0.0) remainder.acceleration_m_s2 = std::sqrt(sizes.q_m2_s3 / part_s);
  remainder.clip_scatter_m_s2 = sizes.force_m_s2;
  remainder.drag_scatter = sizes.drag;
  return remainder;
}

void order_by_share(bool drag_first, Diagnosis& diagnosis) {
  const auto probability = [](const DiagnosedEffect& effect) {
    return std::max(effect.probability, effect.joint_probability);
  };
  double likeliest = 0.0;
  for (const DiagnosedEffect& one : diagnosis.effects) {
    if (!one.by_stated) likeliest = std::max(likeliest, probability(one));
  }
  const auto share = [&](const DiagnosedEffect& effect) {
    const bool first =
        effect.by_stated ? probability(effect) > likeliest : drag_first && effect.id == ids::quadratic_drag;
    if (first) return std::numeric_limits<double>::infinity();
    const auto of = std::find_if(diagnosis.explained.begin(), diagnosis.explained.end(),
                                 [&](const ExplainedCause& cause) { return cause.id == effect.id; });
    return of != diagnosis.explained.end() ? of->share : -std::numeric_limits<double>::infinity();
  };
  std::stable_sort(diagnosis.effects.begin(), diagnosis.effects.end(),
                   [&](const DiagnosedEffect& a, const DiagnosedEffect& b) { return share(a) > share(b); });
  if (!diagnosis.effects.empty()) diagnosis.stage = diagnosis.effects.front().stage;
}

bool names_all(const Diagnosis& diagnosis, const std::vector<std::size_t>& effects) {
  return std::ranges::all_of(effects, [&](std::size_t e) {
    return std::ranges::any_of(diagnosis.effects,
                               [&](const DiagnosedEffect& one) { return one.id == effect_list()[e].id; });
  });
}

}  // namespace glidelab::diagnose
