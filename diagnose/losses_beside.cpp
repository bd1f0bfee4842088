#include "diagnose/losses_beside.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "diagnose/plain_losses.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kLeaders = 4;  // effects, of those alone and of those beside known losses

/// The likeliest effects other than losses, alone and beside these.
std::vector<std::size_t> likeliest_beside(const Comparison& comparison, std::size_t dropped) {
  std::vector<std::size_t> effects;
  const auto add = [&](std::size_t effect) {
    if (effect != dropped && std::find(effects.begin(), effects.end(), effect) == effects.end())
      effects.push_back(effect);
  };
  for (const Hypothesis& one : leaders_of(comparison, 1, kLeaders + 1)) add(one.effects.front());
  std::size_t beside = 0;
  for (const Hypothesis& pair : leaders_of(comparison, 2, comparison.all.size())) {
    const auto& [a, b] = std::pair(pair.effects[0], pair.effects[1]);
    if ((a == dropped || b == dropped) && beside++ < kLeaders) add(a == dropped ? b : a);
  }
  return effects;
}

}  // namespace

void add_losses_beside(const TrackSet& set, const MotionFit& nominal, const std::set<std::size_t>& without,
                       const Work& work, Comparison& comparison) {
  const std::size_t dropped = effect_index("dropped_frames");
  if (without.contains(dropped)) return;
  if (comparison.missing.count + plain_losses(set).count + analysed_losses(set).count == 0) return;
  const std::vector<std::size_t> effects = likeliest_beside(comparison, dropped);
  std::vector<Hypothesis> alone(effects.size());
  std::vector<MissingFrames> missing(effects.size());
  base::for_each_parallel(effects.size(), work.jobs, [&](std::size_t i) {
    work.look();
    if (const Hypothesis* fitted = find(comparison, {effects[i]})) {
      alone[i] = *fitted;
      missing[i] = find_missing_frames(set, comparison.fits[static_cast<std::size_t>(fitted->fit)]);
      return;
    }
    const auto scan = std::find_if(comparison.scans.begin(), comparison.scans.end(),
                                   [&](const EffectScan& of) { return of.effect == effects[i]; });
    if (scan == comparison.scans.end() || scan->values.empty()) return;
    Found found = fit_more(set, nominal, *scan, Hypothesis{});
    alone[i] = found.hypothesis;
    missing[i] = find_missing_frames(set, found.fit);
  });
  double likeliest = comparison.missing.count > 0 ? comparison.missing.effect.log_evidence : 0.0;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (missing[i].count == 0) continue;
    Found both;
    both.fit = missing[i].fit;
    both.hypothesis = alone[i];
    both.hypothesis.effects = {dropped, effects[i]};
    both.hypothesis.gain += missing[i].effect.gain;
    both.hypothesis.log_evidence += missing[i].effect.log_evidence;
    if (both.hypothesis.log_evidence > likeliest) {
      likeliest = both.hypothesis.log_evidence;
      comparison.missing = std::move(missing[i]);
    }
    add(comparison, std::move(both));
  }
}

}  // namespace glidelab::diagnose
