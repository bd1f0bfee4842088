#include "diagnose/causes/scatter_beside.h"

#include <cmath>
#include <utility>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/scan/effect_scan.h"

namespace glidelab::diagnose {

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

}  // namespace glidelab::diagnose
