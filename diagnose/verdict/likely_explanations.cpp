#include "diagnose/verdict/likely_explanations.h"

#include <cmath>
#include <optional>
#include <utility>

#include "diagnose/effects/effect_library.h"
#include "diagnose/twin/twin.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kMostLikely = 6;

}  // namespace

MovedOn moved_on(const TrackSet& set, const MotionFit& fit, bool at_minimum) {
  constexpr int kDescents = 3;
  constexpr double kHardlyLower = 0.1;  // chi²
  MovedOn moved{fit, at_minimum};
  for (int descent = 0; descent < kDescents && !moved.at_minimum && std::isfinite(moved.fit.cost); ++descent) {
    const MotionFit from = linearise_again(set, moved.fit);
    MotionFit next = fit_motions(set, from.effects, from.at, from.late);
    if (!(next.cost <= from.cost)) break;
    moved.at_minimum = next.converged || from.cost - next.cost < kHardlyLower;
    moved.fit = std::move(next);
  }
  return moved;
}

void add_others(const WeighedCauses& weighed, const std::vector<Hypothesis>& all, double unknown,
                const std::vector<std::size_t>& reported, Explanations& explanations) {
  const auto add = [&](std::size_t fit, double probability, const std::vector<std::size_t>& effects) {
    if (probability < kLikely || explanations.size() > kMostLikely || !weighed.fits[fit]) return;
    explanations.push_back({&weighed.fits[fit]->noise_alone, weighed.fits[fit]->sizes, probability, effects});
  };
  if (!reported.empty()) add(0, unknown, {});
  for (const Hypothesis& one : all) {
    if (one.unnamed || one.effects.empty()) continue;
    if (one.effects == reported) {
      explanations.front().probability += one.probability;
    } else if (one.fit > 0) {
      add(static_cast<std::size_t>(one.fit), one.probability, one.effects);
    }
  }
}

void add_others(const Comparison& by_noise, const std::vector<Hypothesis>& all, Explanations& explanations) {
  for (const Hypothesis& one : all) {
    const bool fitted = !one.unnamed && !one.effects.empty() && one.fit > 0;
    const bool reported = fitted && one.effects == explanations.front().effects;
    if (!fitted || reported || one.probability < kLikely || explanations.size() > kMostLikely) continue;
    explanations.push_back({&by_noise.fits[static_cast<std::size_t>(one.fit)], {}, one.probability, one.effects});
    explanations.front().probability -= one.probability;
  }
}

std::vector<LikelyTwin> likely_twins(const TrackSet& set, const Explanations& explanations,
                                     const std::vector<DiagnosedEffect>& reported) {
  std::vector<LikelyTwin> twins;
  for (const LikelyFit& one : explanations) {
    LikelyTwin twin;
    twin.toml = twin_of(set, *one.fit, reported, false, std::nullopt).toml;
    for (const std::size_t e : one.effects) twin.ids.emplace_back(effect_list()[e].id);
    twin.probability = one.probability;
    twin.q_m2_s3 = one.sizes.q_m2_s3;
    twin.force_m_s2 = one.sizes.force_m_s2;
    twin.drag = one.sizes.drag;
    twins.push_back(std::move(twin));
  }
  return twins;
}

}  // namespace glidelab::diagnose
