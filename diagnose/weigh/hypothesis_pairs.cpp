#include "diagnose/weigh/hypothesis_pairs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/long_work.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/single_frames/plain_losses.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kMostLeaders = 3;        // effects that are tried with a second one
constexpr std::size_t kMostSecondEffects = 4;  // effects tried beside a leader
constexpr std::size_t kMostJointPairs = 4;     // pairs that show only together and that no leader found
constexpr int kExchanges = 3;                  // rounds in which each of the best pair's two effects leads in turn

/// A leader with each of the effects that show best beside it.
void add_seconds(const TrackSet& set, const Hypothesis& leader, const std::set<std::size_t>& without, const Work& work,
                 Comparison& comparison) {
  const MotionFit base = comparison.fits[static_cast<std::size_t>(leader.fit)];
  if (!std::isfinite(base.cost)) return;
  const ScoreSpace space(set, base);
  std::set<std::size_t> others = without;
  others.insert(leader.effects.begin(), leader.effects.end());
  work.look();
  const std::vector<EffectScan> scans = scan_effects(space, others, work.jobs);
  std::vector<const EffectScan*> best = best_of(scans, kMostSecondEffects);
  std::erase_if(best, [](const EffectScan* scan) { return scan->log_evidence < -1.0; });
  fit_best(set, base, best, leader, work, comparison);
}

/// One effect's own full fit, made if there is none yet.
Found alone(const TrackSet& set, std::size_t effect, Comparison& comparison) {
  if (const Hypothesis* known = find(comparison, {effect}); known != nullptr) {
    return {*known, comparison.fits[static_cast<std::size_t>(known->fit)]};
  }
  Found found = fit_more(set, comparison.fits.front(), comparison.scans[effect], {});
  add(comparison, found);
  return found;
}

/// The full fit of a second effect that was scanned around some point of the first effect's fit, and its evidence
/// beside that first fit.
Found fit_beside(const TrackSet& set, const MotionFit& around, const EffectScan& scan, const Found& leader) {
  const FitPoint start = with_effect(set, around, scan.effect, scan.values, scan.own);
  Found found;
  found.fit = no_worse_than(set, leader.fit, scan.effect,
                            fit_motions(set, {around.effects.front(), scan.effect}, start, leader.fit.late));
  const double gain = 0.5 * (leader.fit.cost - found.fit.cost);
  found.hypothesis.effects = found.fit.effects;
  found.hypothesis.gain = leader.hypothesis.gain + gain;
  found.hypothesis.log_evidence =
      leader.hypothesis.log_evidence + log_evidence_beyond(set, leader.fit, scan, found.fit);
  return found;
}

/// Two effects fitted at once, starting from their sizes in the neighbourhood of the nominal fit.
void add_together(const TrackSet& set, const PairScan& pair, Comparison& comparison) {
  const auto shows = [&](std::size_t effect) { return comparison.scans[effect].log_evidence; };
  const bool in_order = shows(pair.first) >= shows(pair.second);
  const Found leader = alone(set, in_order ? pair.first : pair.second, comparison);
  EffectScan beside = scan_effect(ScoreSpace(set, leader.fit), in_order ? pair.second : pair.first);
  if (!beside.visible) return;
  beside.values = in_order ? pair.second_values : pair.first_values;
  MotionFit first = comparison.fits.front();
  first.at =
      with_effect(set, first, leader.hypothesis.effects.front(), in_order ? pair.first_values : pair.second_values, {});
  first.effects = leader.hypothesis.effects;
  add(comparison, fit_beside(set, first, beside, leader));
}

/// The joint fit of two effects, with one of them removed. What is missing then shows as it is, and not as the other
/// effect's own fit has compensated for it.
MotionFit without_one(const TrackSet& set, const MotionFit& both, std::size_t kept) {
  const ParameterLayout layout(set, {kept});
  FitPoint at{Eigen::VectorXd(static_cast<Eigen::Index>(layout.globals().size())), {}};
  Eigen::Index to = 0;
  for (std::size_t g = 0; g < both.layout->globals().size(); ++g) {
    const ParameterLayout::Global& global = both.layout->globals()[g];
    if (global.kind == ParameterLayout::Global::Kind::effect && global.effect != kept) continue;
    at.global[to++] = both.at.global[static_cast<Eigen::Index>(g)];
  }
  const bool first = both.effects.front() == kept;
  const auto own = static_cast<Eigen::Index>(layout.own().size());
  for (const Eigen::VectorXd& motion : both.at.own) {
    Eigen::VectorXd of_one(2 + own);
    of_one << motion.head(2), (first ? motion.segment(2, own) : motion.tail(own));
    at.own.push_back(of_one);
  }
  return linearise_at(set, {kept}, at);
}

/// The same pair with the evidence of its first effect beside its second. The prior penalty of an effect by itself,
/// where it has to compensate for the other, is not its penalty beside the other.
std::optional<Found> turned(const TrackSet& set, const MotionFit& both, Comparison& comparison) {
  const Found leader = alone(set, both.effects.back(), comparison);
  const MotionFit around = without_one(set, both, both.effects.back());
  if (!std::isfinite(around.cost)) return std::nullopt;
  const EffectScan scan = scan_effect(ScoreSpace(set, around), both.effects.front());
  Found found;
  found.fit = no_worse_than(set, leader.fit, both.effects.front(), both);
  const double gain = 0.5 * (leader.fit.cost - found.fit.cost);
  found.hypothesis.effects = {both.effects.back(), both.effects.front()};
  found.hypothesis.gain = leader.hypothesis.gain + gain;
  found.hypothesis.log_evidence =
      leader.hypothesis.log_evidence + log_evidence_beyond(set, leader.fit, scan, found.fit);
  return found;
}

/// Replaces one effect of the best pair by whatever shows best beside the other; then repeats this with the new best
/// pair.
void exchange(const TrackSet& set, double best_one, const std::set<std::size_t>& without, const Work& work,
              Comparison& comparison) {
  for (int round = 0; round < kExchanges; ++round) {
    const std::vector<Hypothesis> pairs = leaders_of(comparison, 2, 1);
    if (pairs.empty() || pairs.front().log_evidence <= best_one) return;
    const Hypothesis best = pairs.front();
    const MotionFit both = comparison.fits[static_cast<std::size_t>(best.fit)];
    if (both.effects.size() < 2) return;  // missing frames are in the fit's times
    for (const std::size_t kept : both.effects) {
      const Found leader = alone(set, kept, comparison);
      const MotionFit base = without_one(set, both, kept);
      if (!std::isfinite(base.cost)) continue;  // without the drag of a fall the other effect may run away
      std::set<std::size_t> others = without;
      others.insert(both.effects.begin(), both.effects.end());
      work.look();
      const std::vector<EffectScan> scans = scan_effects(ScoreSpace(set, base), others, work.jobs);
      std::vector<const EffectScan*> seconds = best_of(scans, kMostSecondEffects);
      std::vector<Found> found(seconds.size());
      base::for_each_parallel(seconds.size(), work.jobs, [&](std::size_t i) {
        work.look();
        found[i] = fit_beside(set, base, *seconds[i], leader);
      });
      for (const Found& one : found) {
        add(comparison, one);
        if (!(one.hypothesis.gain > best.gain)) continue;
        if (std::optional<Found> other = turned(set, one.fit, comparison)) add(comparison, std::move(*other));
      }
    }
    if (leaders_of(comparison, 2, 1).front().effects == best.effects) return;
  }
}

/// A drag and its air are one cause, beside which others may act. A hand is in every fall, and is tried however others
/// show.
void add_to_drag_with_its_air(const TrackSet& set, const std::set<std::size_t>& without, const Work& work,
                              Comparison& comparison) {
  const std::set<std::size_t> drag_and_air = {effect_index(ids::quadratic_drag), effect_index(ids::rotational_inertia)};
  const Hypothesis* found = find(comparison, drag_and_air);
  if (found == nullptr) return;
  const Hypothesis with_air = *found;
  add_seconds(set, with_air, without, work, comparison);
  const std::size_t hand = effect_index(ids::late_release);
  std::set<std::size_t> with_hand = drag_and_air;
  with_hand.insert(hand);
  const MotionFit base = comparison.fits[static_cast<std::size_t>(with_air.fit)];
  if (without.contains(hand) || !std::isfinite(base.cost) || find(comparison, with_hand) != nullptr) return;
  const EffectScan scan = scan_effect(ScoreSpace(set, base), hand);
  if (scan.visible) add(comparison, fit_more(set, base, scan, with_air));
}

/// Clips that scatter beside a leader that shows mostly in what the experimenter states: a scale or a clock that is off
/// shifts inclinations, which no scatter of the clips absorbs.
void add_scatter_beside_statements(const TrackSet& set, const std::vector<Hypothesis>& leaders, const Work& work,
                                   Comparison& comparison) {
  const std::size_t scatter = effect_index(ids::clip_scatter);
  for (const Hypothesis& leader : leaders) {
    const MotionFit base = comparison.fits[static_cast<std::size_t>(leader.fit)];
    const MotionFit& nominal = comparison.fits.front();
    const double stated = gain_in_stated(nominal, base);
    if (stated < std::max(kClearInStated, 0.5 * (nominal.cost - base.cost))) continue;
    work.look();
    const EffectScan scan = scan_effect(ScoreSpace(set, base), scatter);
    if (scan.visible && !scan.values.empty()) add(comparison, fit_more(set, base, scan, leader));
  }
}

}  // namespace

void add_pairs(const TrackSet& set, const ScoreSpace& nominal, const std::set<std::size_t>& without, const Work& work,
               Comparison& comparison) {
  // Effects that differ between clips absorb whatever a first effect leaves: they are the whole explanation or none,
  // not half of a pair.
  std::set<std::size_t> left_out = without;
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    if (differs_between_clips(e)) left_out.insert(e);
  }
  std::vector<Hypothesis> leaders = leaders_of(comparison, 1, kMostLeaders + 1);
  std::erase_if(leaders, [](const Hypothesis& one) { return differs_between_clips(one.effects.front()); });
  leaders.resize(std::min(leaders.size(), kMostLeaders));
  // In a fall the quadratic drag leads, even if another drag imitates it and what else acts.
  const std::size_t air = effect_index(ids::quadratic_drag);
  const Hypothesis* through_air = set.through_air ? find(comparison, {air}) : nullptr;
  if (through_air != nullptr &&
      std::none_of(leaders.begin(), leaders.end(), [&](const Hypothesis& one) { return one.effects.front() == air; })) {
    leaders.push_back(*through_air);
  }
  if (const std::size_t inertia = effect_index(ids::rotational_inertia);
      through_air != nullptr && !without.contains(inertia)) {
    // Air that weighs as much as the object is far from any linear estimate, so the pair is fitted however it shows.
    const Hypothesis drag = *through_air;
    const MotionFit base = comparison.fits[static_cast<std::size_t>(drag.fit)];
    EffectScan scan;
    if (std::isfinite(base.cost)) scan = scan_effect(ScoreSpace(set, base), inertia);
    if (scan.visible && !scan.values.empty()) {
      Found beside = fit_more(set, base, scan, drag);
      scan.values.front() = lightest_kg(set);
      Found heavier = fit_more(set, base, scan, drag);
      add(comparison, heavier.fit.cost < beside.fit.cost ? std::move(heavier) : std::move(beside));
    }
  }
  double best_one = 0.0;
  for (const Hypothesis& leader : leaders) {
    if (leader.log_evidence < 0.0 && !(set.through_air && leader.effects.front() == air)) continue;
    best_one = std::max(best_one, leader.log_evidence);
    add_seconds(set, leader, left_out, work, comparison);
  }
  if (through_air != nullptr) add_to_drag_with_its_air(set, left_out, work, comparison);
  std::size_t more = 0;
  for (const PairScan& pair : scan_pairs(nominal, comparison.scans)) {
    if (more == kMostJointPairs || pair.log_evidence <= best_one) break;
    if (find(comparison, {pair.first, pair.second}) != nullptr) continue;
    ++more;
    work.look();
    add_together(set, pair, comparison);
  }
  exchange(set, best_one, left_out, work.at(0.6), comparison);
  if (!without.contains(effect_index(ids::clip_scatter))) {
    add_scatter_beside_statements(set, leaders, work, comparison);
  }
}

namespace {

constexpr std::size_t kLikeliest = 4;  // number of effects, of those alone and of those beside known losses

/// An explanation, and the places where frames are missing beside it.
struct Beside {
  Hypothesis of;
  MissingFrames missing;
};

/// The likeliest fitted explanations by losses and one effect.
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

/// Missing frames along the fit of an effect without any losses.
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
    // A wave's phase jumps with each loss. A wave is found if these losses are known, and further losses are found
    // along it.
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
