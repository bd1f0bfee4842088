#include "diagnose/weigh/losses_beside.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/frames/obvious_losses.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kLikeliest = 4;  // effects, of those alone and of those beside known losses

/// An explanation, and where frames are missing beside it.
struct Beside {
  Hypothesis of;
  MissingFrames missing;
};

/// The likeliest explanations of losses and one effect that were fitted.
std::vector<Hypothesis> pairs_with(std::size_t dropped, const Comparison& comparison) {
  std::vector<Hypothesis> pairs = leaders_of(comparison, 2, comparison.all.size());
  std::erase_if(pairs, [&](const Hypothesis& pair) {
    return std::find(pair.effects.begin(), pair.effects.end(), dropped) == pair.effects.end();
  });
  pairs.resize(std::min(pairs.size(), kLikeliest));
  return pairs;
}

/// The likeliest effects other than losses, alone and beside these.
std::vector<std::size_t> likeliest_beside(std::size_t dropped, const std::vector<Hypothesis>& pairs,
                                          const Comparison& comparison) {
  std::vector<std::size_t> effects;
  const auto add = [&](std::size_t effect) {
    if (effect != dropped && std::find(effects.begin(), effects.end(), effect) == effects.end())
      effects.push_back(effect);
  };
  for (const Hypothesis& one : leaders_of(comparison, 1, kLikeliest + 1)) add(one.effects.front());
  for (const Hypothesis& pair : pairs) {
    for (const std::size_t effect : pair.effects) add(effect);
  }
  return effects;
}

/// Along the fit of an effect without any losses.
Beside beside_effect(const TrackSet& set, const MotionFit& nominal, std::size_t effect, const Comparison& comparison) {
  if (const Hypothesis* fitted = find(comparison, {effect})) {
    return {*fitted, find_missing_frames(set, comparison.fits[static_cast<std::size_t>(fitted->fit)])};
  }
  const auto scan = std::find_if(comparison.scans.begin(), comparison.scans.end(),
                                 [&](const EffectScan& of) { return of.effect == effect; });
  if (scan == comparison.scans.end() || scan->values.empty()) return {};
  const Found found = fit_more(set, nominal, *scan, Hypothesis{});
  return {found.hypothesis, find_missing_frames(set, found.fit)};
}

}  // namespace

void add_losses_beside(const TrackSet& set, const MotionFit& nominal, const std::set<std::size_t>& without,
                       const Work& work, Comparison& comparison) {
  const std::size_t dropped = effect_index(ids::dropped_frames);
  if (without.contains(dropped)) return;
  if (comparison.missing.count + plain_losses(set).count + analysed_losses(set).count == 0) return;
  const std::vector<Hypothesis> pairs = pairs_with(dropped, comparison);
  const std::vector<std::size_t> effects = likeliest_beside(dropped, pairs, comparison);
  std::vector<Beside> beside(pairs.size() + effects.size());
  base::for_each_parallel(beside.size(), work.jobs, [&](std::size_t i) {
    work.look();
    if (i >= pairs.size()) {
      beside[i] = beside_effect(set, nominal, effects[i - pairs.size()], comparison);
      return;
    }
    // A wave's phase jumps with each loss: it is found where these are known, and others along it.
    beside[i] = {pairs[i], find_more_missing_frames(set, comparison.fits[static_cast<std::size_t>(pairs[i].fit)])};
  });
  for (const Beside& one : beside) {
    if (one.missing.count == 0) continue;
    Found both;
    both.fit = one.missing.fit;
    both.hypothesis = one.of;
    if (one.of.effects.size() == 1) both.hypothesis.effects.push_back(dropped);
    both.hypothesis.gain += one.missing.effect.gain;
    both.hypothesis.log_evidence += one.missing.effect.log_evidence;
    add(comparison, std::move(both));
  }
}

}  // namespace glidelab::diagnose
