#include "diagnose/causes/cause_sequence.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnose/effects/effect_library.h"
#include "diagnose/gap/gap_sizes.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/scan/effect_scan.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kMostCauses = 4;
constexpr std::size_t kTried = 3;     // further effects fitted in full at each step
constexpr double kMostOfRest = 0.5;   // of what the causes before leave: a further cause that takes it has a name
constexpr double kWorthTrying = 5.0;  // log evidence beside the remainder, above which an effect is fitted

struct Step {
  MotionFit fit;
  double gap = 1.0;
  double standard_error = 0.0;
  std::vector<ClipSquares> clips;
};

Step step_of(const TrackSet& set, MotionFit fit) {
  Step step;
  const HeldOutGap gap = held_out_gap(set, fit);
  step.gap = gap.value;
  step.standard_error = gap.standard_error;
  for (const ClipGap& clip : gap.clips) step.clips.push_back({clip.chi2, clip.freedom});
  step.fit = std::move(fit);
  return step;
}

/// The stretches or pieces of one clip do not differ as clips do, so there is no interval over them.
bool is_one_clip(const TrackSet& set) {
  return set.pieces || set.clips.size() < 2;
}

bool is_above_floor(const Step& step) {
  return step.gap > 1.0 + kClearGap * step.standard_error;
}

ExplainedCause cause_of(std::size_t effect, const Step& first, const Step& before, const Step& after, bool one_clip,
                        double floor = 1.0) {
  ExplainedCause cause;
  cause.id = effect_list()[effect].id;
  cause.gap_after = after.gap;
  cause.share = (before.gap * before.gap - after.gap * after.gap) / (first.gap * first.gap - floor * floor);
  if (!one_clip) cause.share_interval95 = share_interval(first.clips, before.clips, after.clips, floor);
  return cause;
}

/// The part that a step takes of what the one before it leaves above the noise; 0 if that is less than the noise.
double share_of_rest(const Step& before, const Step& after) {
  const double excess = before.gap * before.gap - 1.0;
  if (!is_above_floor(before) || excess < 1.0) return 0.0;
  return (before.gap * before.gap - after.gap * after.gap) / excess;
}

/// Whether a cause takes more than the uncertainty of its share.
bool takes_for_certain(const ExplainedCause& cause) {
  return !cause.share_interval95 || cause.share_interval95->low > 0.0;
}

/// Whether a cause beyond those of the verdict is worth a step.
bool is_worth(const ExplainedCause& cause) {
  return cause.share > kLeastShare && takes_for_certain(cause);
}

/// The parameters of effects that are no sizes: where a cable tightens, until when a hand pushes, how fast a table
/// shakes.
std::vector<std::size_t> shapes_of(const ParameterLayout& layout) {
  std::vector<std::size_t> shapes;
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const ParameterLayout::Global& of = layout.globals()[g];
    if (of.kind != ParameterLayout::Global::Kind::effect || of.parameter->each != Each::experiment) continue;
    const EffectInfo& info = effect_list()[of.effect];
    const std::size_t parameter = of.parameter->slot.parameter;
    const bool is_size = parameter >= info.law.size && parameter < info.law.size + info.law.sizes;
    if (!is_size && info.search != Search::spread) shapes.push_back(g);
  }
  return shapes;
}

/// The fit to `set` with these effects, started from a fit that has all of them. If that has more, the shapes stay as
/// they are there: a hand that pushes for half a second, where a law is missing, is not the hand of a tenth of a second
/// that was found beside the law, and what it takes is not the share of that hand.
std::optional<MotionFit> fit_with(const TrackSet& set, const MotionFit& from, const std::vector<std::size_t>& effects,
                                  const Lateness& late) {
  const ParameterLayout layout(set, effects);
  const FitPoint start = with_some_effects(layout, from);
  const bool is_part = effects.size() < from.effects.size();
  MotionFit fit = fit_held(set, effects, start, late, is_part ? shapes_of(layout) : std::vector<std::size_t>());
  if (!std::isfinite(fit.cost)) return {};
  return fit;
}

/// A step with those of `left` beside it that bring the motion to what is stated of its inclinations, whatever they
/// take of the gap.
Step with_causes_by_stated(const TrackSet& set, Step here, const MotionFit& named,
                           const std::vector<std::size_t>& left) {
  for (const std::size_t effect : left) {
    std::vector<std::size_t> effects = here.fit.effects;
    effects.push_back(effect);
    std::optional<MotionFit> fit = fit_with(set, named, effects, here.fit.late);
    if (!fit || gain_in_stated(here.fit, *fit) < kClearInStated) continue;
    Step step = step_of(set, std::move(*fit));
    if (step.gap < here.gap + here.standard_error) here = std::move(step);
  }
  return here;
}

/// The best further cause beside those of a step, or nothing.
std::optional<std::pair<std::size_t, Step>> next_cause(const TrackSet& set, const TrackSet& with, const Step& here,
                                                       const std::set<std::size_t>& without) {
  std::set<std::size_t> out = without;
  out.insert(here.fit.effects.begin(), here.fit.effects.end());
  const MotionFit beside = linearise_again(with, here.fit);
  if (!std::isfinite(beside.cost)) return {};
  const ScoreSpace space(with, beside);
  std::vector<EffectScan> scans = scan_effects(space, out, 1);
  std::erase_if(scans, [](const EffectScan& scan) {
    return !scan.visible || scan.values.empty() || !(scan.log_evidence > kWorthTrying);
  });
  std::sort(scans.begin(), scans.end(), [](const auto& a, const auto& b) { return a.log_evidence > b.log_evidence; });
  if (scans.size() > kTried) scans.resize(kTried);
  std::optional<std::pair<std::size_t, Step>> best;
  for (const EffectScan& scan : scans) {
    std::vector<std::size_t> effects = here.fit.effects;
    effects.push_back(scan.effect);
    const FitPoint start = with_effect(set, here.fit, scan.effect, scan.values, scan.own);
    MotionFit fit = fit_motions(set, effects, start, here.fit.late);
    if (!std::isfinite(fit.cost) || fit.cost > here.fit.cost) continue;
    Step step = step_of(set, std::move(fit));
    // Laws for all clips first.
    const bool follows = best && follows_each_clip(scan.effect) && !follows_each_clip(best->first);
    const bool leads = best && !follows_each_clip(scan.effect) && follows_each_clip(best->first);
    if (!best || leads || (!follows && step.gap < best->second.gap)) best = {scan.effect, std::move(step)};
  }
  return best;
}

}  // namespace

bool has_gap(const TrackSet& set, const MotionFit& fit) {
  return is_above_floor(step_of(set, fit));
}

double held_out_excess(const TrackSet& set, const MotionFit& fit) {
  const double gap = step_of(set, fit).gap;
  return gap * gap - 1.0;
}

CauseSequence sequence_of(const TrackSet& set, const MotionFit& nominal, const TrackSet& with, const MotionFit& named,
                          const std::set<std::size_t>& without, double least_named) {
  CauseSequence sequence;
  const Step first = step_of(set, nominal);
  sequence.gap_before = sequence.gap_after = first.gap;
  sequence.standard_error = first.standard_error;
  sequence.named = nominal;
  sequence.is_gap = is_above_floor(first);
  if (!sequence.is_gap) return sequence;

  // The causes that the verdict names. Of several, each is tried alone first.
  Step here = first;
  std::vector<std::pair<std::size_t, Step>> steps;  // each cause, and the step that adds it
  const std::size_t dropped =
      effect_index(ids::dropped_frames);  // missing frames are in a fit's times, not among its effects
  std::vector<std::size_t> left = named.effects;
  if (!named.late.empty() && nominal.late.empty()) left.push_back(dropped);
  // The best of `left` beside the causes so far, and its index.
  const std::size_t air = effect_index(ids::quadratic_drag);
  // Without its drag a fall is so far off that whatever else acts could only imitate the drag. So the drag comes first,
  // unless it takes its part only beside another cause.
  bool drag_first = set.no_drag && std::find(left.begin(), left.end(), air) != left.end();
  const auto best_of = [&](bool laws_only) {
    std::optional<std::pair<std::size_t, Step>> best;
    for (std::size_t k = 0; k < left.size(); ++k) {
      if (laws_only && differs_between_clips(left[k])) continue;
      if (drag_first && left[k] != air) continue;
      std::vector<std::size_t> effects = here.fit.effects;
      if (left[k] != dropped) effects.push_back(left[k]);
      std::optional<MotionFit> fit = fit_with(set, named, effects, left[k] == dropped ? named.late : here.fit.late);
      if (!fit) continue;
      Step step = step_of(set, std::move(*fit));
      if (!best || step.gap < best->second.gap) best = {k, std::move(step)};
    }
    return best;
  };
  // What of the excess a cause is measured by, to be worth a name. A fall without any drag lies so far off that nothing
  // would be worth a name beside the drag. Beside it, what the drag leaves is the measure.
  const auto whole = [&]() -> const Step& {
    const bool beside_drag = set.no_drag && !steps.empty() && is_above_floor(steps.front().second);
    return beside_drag ? steps.front().second : first;
  };
  while (!left.empty()) {
    // Laws that all clips have in common come first: sizes of each clip's own would absorb what these explain.
    std::optional<std::pair<std::size_t, Step>> best;
    for (const bool laws_only : {true, false}) {
      best = best_of(laws_only);
      if (!best) continue;
      const ExplainedCause cause = cause_of(left[best->first], whole(), here, best->second, is_one_clip(set));
      if (cause.share > (steps.empty() ? kLeastShare : least_named)) break;
      // A large cause must not hide a second one that for certain explains most of what it leaves.
      if (!steps.empty() && takes_for_certain(cause) && share_of_rest(here, best->second) >= kMostOfRest) break;
      best.reset();
      if (std::none_of(left.begin(), left.end(), differs_between_clips)) break;
    }
    if (!best && std::exchange(drag_first, false)) continue;
    if (!best) break;
    drag_first = false;
    const std::size_t which = best->first;
    here = std::move(best->second);
    steps.emplace_back(left[which], here);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(which));
  }
  if (!steps.empty() && here.fit.effects.size() < named.effects.size()) {
    // These are all that is named, so their shapes are free again, unless the fit then loses held-out positions that
    // the cause before explains.
    Step free = step_of(set, fit_motions(set, here.fit.effects, here.fit.at, here.fit.late));
    const double before = steps.size() > 1 ? steps[steps.size() - 2].second.gap : first.gap;
    if (free.gap < std::max(before, here.gap)) {
      here = std::move(free);
      steps.back().second = here;
    }
  }
  std::erase(left, dropped);
  const std::size_t of_gap = here.fit.effects.size();
  if (!left.empty()) here = with_causes_by_stated(set, std::move(here), named, left);
  sequence.by_stated.insert(here.fit.effects.begin() + static_cast<std::ptrdiff_t>(of_gap), here.fit.effects.end());
  sequence.named = here.fit;
  const std::size_t named_steps = steps.size();

  while (steps.size() < kMostCauses && is_above_floor(here)) {
    auto next = next_cause(set, with, here, without);
    if (!next) break;
    if (!is_worth(cause_of(next->first, whole(), here, next->second, is_one_clip(set)))) break;
    here = next->second;
    steps.push_back(std::move(*next));
  }
  sequence.gap_after = here.gap;
  const double floor = floor_of(here.gap, here.standard_error);
  const Step* before = &first;
  for (const auto& [effect, after] : steps) {
    sequence.causes.push_back(cause_of(effect, first, *before, after, is_one_clip(set), floor));
    if (sequence.causes.size() <= named_steps) sequence.named_share += sequence.causes.back().share;
    before = &after;
  }
  return sequence;
}

}  // namespace glidelab::diagnose
