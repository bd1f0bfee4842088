#include "diagnose/causes/further_causes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/long_work.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/single_frames/missing_frames.h"

namespace glidelab::diagnose {
namespace {

constexpr double kShowsBeside = 3.0;           // log evidence beside a remainder, above which an effect is fitted
constexpr std::size_t kMostBesideScatter = 3;  // laws

bool shows(const EffectScan& scan) {
  return scan.visible && !scan.values.empty() && scan.log_evidence > kShowsBeside;
}

}  // namespace

std::optional<MotionFit> with_clip_scatter(const TrackSet& set, const MotionFit& law) {
  const std::size_t scatter = effect_index(ids::clip_scatter);
  const EffectScan scan = scan_effect(ScoreSpace(set, law), scatter);
  if (!scan.visible || scan.values.empty()) return {};
  std::vector<std::size_t> effects = law.effects;
  effects.push_back(scatter);
  MotionFit fit = no_worse_than(
      set, law, scatter, fit_motions(set, effects, with_effect(set, law, scatter, scan.values, scan.own), law.late));
  if (!std::isfinite(fit.cost)) return {};
  return fit;
}

std::optional<MotionFit> with_further(const TrackSet& set, const MotionFit& law, std::size_t effect,
                                      const RemainderSizes& sizes) {
  if (!std::isfinite(law.cost)) return {};
  const BesideRemainder beside = beside_remainder(set, law, sizes);
  if (!std::isfinite(beside.fit.cost)) return {};
  const EffectScan scan = scan_effect(ScoreSpace(beside.set, beside.fit), effect);
  if (!shows(scan)) return {};
  MotionFit fit = fit_with_effect(set, law, effect, with_effect(set, law, effect, scan.values, scan.own));
  if (!std::isfinite(fit.cost)) return {};
  return fit;
}

std::vector<MotionFit> laws_beside_scatter(const TrackSet& set, const MotionFit& scatter, const RemainderSizes& sizes,
                                           const std::set<std::size_t>& without) {
  std::set<std::size_t> others = without;
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    const bool is_law = !differs_between_clips(e) && !follows_each_clip(e);
    if (!is_law || !shows_in_motion(effect_list()[e].search)) others.insert(e);
  }
  if (!std::isfinite(scatter.cost)) return {};
  const BesideRemainder beside = beside_remainder(set, scatter, sizes);
  if (!std::isfinite(beside.fit.cost)) return {};
  std::vector<EffectScan> scans = scan_effects(ScoreSpace(beside.set, beside.fit), others, 1);
  std::erase_if(scans, [](const EffectScan& scan) { return !shows(scan); });
  std::sort(scans.begin(), scans.end(), [](const auto& a, const auto& b) { return a.log_evidence > b.log_evidence; });
  if (scans.size() > kMostBesideScatter) scans.resize(kMostBesideScatter);
  std::vector<MotionFit> fits;
  for (const EffectScan& scan : scans) {
    MotionFit fit =
        fit_with_effect(set, scatter, scan.effect, with_effect(set, scatter, scan.effect, scan.values, scan.own));
    if (std::isfinite(fit.cost)) fits.push_back(std::move(fit));
  }
  return fits;
}

std::optional<MotionFit> lost_frames_alone(const TrackSet& set, const std::vector<MotionFit>& fits, int jobs) {
  std::vector<const MotionFit*> found;
  for (const MotionFit& fit : fits) {
    if (!fit.late.empty() && std::isfinite(fit.cost)) found.push_back(&fit);
  }
  const ParameterLayout layout(set, {});
  std::vector<MotionFit> anew(found.size());
  base::for_each_parallel(found.size(), jobs, [&](std::size_t k) {
    anew[k] = fit_motions(set, {}, with_some_effects(layout, *found[k]), found[k]->late);
  });
  // As in their search, a loss has to be worth its price.
  const auto with_price = [&](const MotionFit& fit) {
    return std::isfinite(fit.cost) ? fit.cost + 2.0 * kLeastFrameGain * static_cast<double>(missing_in(set, fit))
                                   : std::numeric_limits<double>::infinity();
  };
  const auto best = std::min_element(
      anew.begin(), anew.end(), [&](const MotionFit& a, const MotionFit& b) { return with_price(a) < with_price(b); });
  if (best == anew.end() || !std::isfinite(best->cost)) return {};
  return std::move(*best);
}

}  // namespace glidelab::diagnose
