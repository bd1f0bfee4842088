#include "diagnose/causes/chosen_explanations.h"

#include <algorithm>
#include <utility>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"

namespace glidelab::diagnose {
namespace {

constexpr double kNearlyAsLikely = 0.1;  // relative to the probability of the likeliest explanation
constexpr std::size_t kMostBeside = 8;   // explanations beside which a function without a name is weighed
constexpr std::size_t kWithScatter = 3;  // laws that are weighed together with clip scatter
constexpr double kMuchLeft = 0.1;        // of the excess: a law that leaves less needs no clip scatter beside it,
constexpr double kAboveNoise = 1.0;      // unless that is an excess of more than the noise

std::vector<Hypothesis> by_falling_evidence(std::vector<Hypothesis> all) {
  std::sort(all.begin(), all.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  return all;
}

/// The hypotheses as weighed by what is known so far, by falling probability.
std::vector<Hypothesis> weighed_so_far(const Comparison& comparison, const LeftExcess& excess) {
  Comparison so_far;
  so_far.all = comparison.all;
  so_far.odds = comparison.odds;
  so_far.fit_odds = comparison.fit_odds;
  so_far.by_stated = comparison.by_stated;
  weigh_beside_remainder(excess, so_far);
  return std::move(so_far.all);
}

}  // namespace

const Hypothesis* pure_of(const Comparison& comparison, int fit) {
  for (const Hypothesis& one : comparison.all) {
    if (one.fit != fit || one.unnamed) continue;
    std::vector<std::size_t> a = one.effects, b = comparison.fits[static_cast<std::size_t>(fit)].effects;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    // Missing frames are in a fit's times, not among its effects.
    std::erase(a, effect_index(ids::dropped_frames));
    std::erase(b, effect_index(ids::dropped_frames));
    if (a == b) return &one;
  }
  return nullptr;
}

std::vector<std::size_t> likeliest_fits(const Comparison& by_noise) {
  std::vector<std::size_t> fits{0};
  for (const Hypothesis& one : by_falling_evidence(by_noise.all)) {
    if (one.fit <= 0 || fits.size() >= kMostByNoise) continue;
    const auto fit = static_cast<std::size_t>(one.fit);
    if (std::find(fits.begin(), fits.end(), fit) == fits.end()) fits.push_back(fit);
  }
  return fits;
}

std::vector<std::size_t> worth_profiling(const TrackSet& set, const Comparison& comparison) {
  std::vector<std::size_t> worth = {0};
  for (const Hypothesis& one : by_falling_evidence(comparison.all)) {
    if (one.fit <= 0 || one.unnamed) continue;
    const auto fit = static_cast<std::size_t>(one.fit);
    // Single effects are always weighed: a remainder of their own may suit them better than the common one.
    if (worth.size() >= kMostProfiled && one.effects.size() > 1 &&
        !(set.through_air && is_drag_with_its_air(one.effects)))
      continue;
    if (std::find(worth.begin(), worth.end(), fit) == worth.end()) worth.push_back(fit);
  }
  return worth;
}

std::vector<Hypothesis> worth_a_function(const Comparison& comparison, const LeftExcess& excess) {
  std::vector<Hypothesis> result = {*pure_of(comparison, 0)};
  for (const std::size_t many : {2, 1}) {
    std::size_t left = many;
    for (const Hypothesis& one : leaders_of(comparison, 3 - many, comparison.all.size())) {
      if (left == 0 || std::any_of(one.effects.begin(), one.effects.end(), is_scatter)) continue;
      result.push_back(one);
      --left;
    }
  }
  const std::vector<Hypothesis> so_far = weighed_so_far(comparison, excess);
  double likeliest = 0.0;
  for (const Hypothesis& one : so_far) {  // by falling probability
    if (one.fit <= 0 || one.unnamed || std::any_of(one.effects.begin(), one.effects.end(), is_scatter)) continue;
    likeliest = std::max(likeliest, one.probability);
    if (one.probability < kNearlyAsLikely * likeliest || result.size() >= kMostBeside) break;
    const bool known =
        std::any_of(result.begin(), result.end(), [&](const auto& other) { return other.fit == one.fit; });
    const Hypothesis* pure = known ? nullptr : pure_of(comparison, one.fit);
    if (pure != nullptr) result.push_back(*pure);
  }
  return result;
}

std::vector<Hypothesis> likeliest_laws(const Comparison& comparison, const LeftExcess& excess) {
  std::vector<Hypothesis> laws;
  for (const Hypothesis& one : weighed_so_far(comparison, excess)) {
    const bool all_show = std::all_of(one.effects.begin(), one.effects.end(),
                                      [](std::size_t e) { return shows_in_motion(effect_list()[e].search); });
    if (one.fit <= 0 || one.unnamed || one.effects.empty() || !all_show) continue;
    const Hypothesis* pure = pure_of(comparison, one.fit);
    if (pure == nullptr) continue;
    laws.push_back(*pure);
    laws.back().left = one.left;
  }
  return laws;
}

std::vector<Hypothesis> laws_that_leave_much(const Comparison& comparison, const LeftExcess& excess) {
  std::vector<Hypothesis> laws = likeliest_laws(comparison, excess);
  std::erase_if(laws, [&](const Hypothesis& one) {
    const double left = excess.of_fits[static_cast<std::size_t>(one.fit)];
    return one.effects.size() != 1 || differs_between_clips(one.effects.front()) ||
           !(one.left.value_or(0.0) >= kMuchLeft || left > kAboveNoise);
  });
  if (laws.size() > kWithScatter) laws.resize(kWithScatter);
  return laws;
}

}  // namespace glidelab::diagnose
