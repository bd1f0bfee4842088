#include "diagnose/verdict/verdict_with_causes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "diagnose/causes/cause_odds.h"
#include "diagnose/causes/cause_sequence.h"
#include "diagnose/causes/cause_weighing.h"
#include "diagnose/causes/gap_levels.h"
#include "diagnose/causes/recovered.h"
#include "diagnose/causes/remainder.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/size_uncertainty.h"
#include "diagnose/tracks/rounded_positions.h"
#include "diagnose/twin/twin.h"
#include "diagnose/unnamed/unnamed.h"
#include "diagnose/verdict/probabilities_by_share.h"
#include "diagnose/verdict/verdict.h"
#include "diagnose/verdict/verdict_details.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastUnknown = 0.5;  // probability of something without a name, above which a remainder is weighed
constexpr double kLeastDoubt =
    0.05;  // probability of none or unknown, above which names by the noise alone are in doubt
constexpr double kMostOfOneClip = 0.999;  // the highest probability that one clip can support

constexpr double kLeastNamed = 0.1;       // of the excess: a smaller share counts as part of the remainder
constexpr double kClearlyLikelier = 0.1;  // difference of probability: a smaller one is no reason to name another cause
constexpr double kLeastMeasuredGap = 0.5;  // a gap below which the assumed noise is not that of the positions
constexpr double kOpenSize = 0.25;    // the least probability of an unknown cause beside a name without a certain size
constexpr double kSureScatter = 0.9;  // probability from which scatter without a gap is the verdict

double probability_of_scatter(const Comparison& comparison) {
  double sum = 0.0;
  for (const Hypothesis& one : comparison.all) sum += is_scatter_alone(one) ? one.probability : 0.0;
  return sum;
}

bool shows_in_images(const Hypothesis& best) {
  return std::any_of(best.effects.begin(), best.effects.end(),
                     [](std::size_t e) { return effect_list()[e].search == Search::images; });
}

/// With an unknown cause, the causes that help and together take less than half of the excess. A cause that would take
/// more is not likely enough to be named, so it is not said to explain anything. Neither is one beside which held-out
/// positions lie farther off than without it.
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

/// Where the rest of the gap lies beside the named causes. Empty if nothing is left.
std::vector<GapRegion> regions_beside(const TrackSet& set, const CauseSequence& sequence, int jobs) {
  if (!(sequence.gap_after > 1.0 + kClearGap * sequence.standard_error)) return {};
  Diagnosis rest;
  rest.verdict = Verdict::unknown;
  add_regions(set, sequence.named, unnamed_families(ScoreSpace(set, sequence.named), jobs), rest);
  return rest.regions;
}

/// Puts the effects that a verdict names in order of falling share, and then those that no motion shows. In a fall
/// through air the drag comes first: the other shares are what is left beside it.
void order_by_share(bool drag_first, Diagnosis& diagnosis) {
  const auto share = [&](const DiagnosedEffect& effect) {
    if (drag_first && effect.id == ids::quadratic_drag) return std::numeric_limits<double>::infinity();
    const auto of = std::find_if(diagnosis.explained.begin(), diagnosis.explained.end(),
                                 [&](const ExplainedCause& cause) { return cause.id == effect.id; });
    return of != diagnosis.explained.end() ? of->share : -std::numeric_limits<double>::infinity();
  };
  std::stable_sort(diagnosis.effects.begin(), diagnosis.effects.end(),
                   [&](const DiagnosedEffect& a, const DiagnosedEffect& b) { return share(a) > share(b); });
  if (!diagnosis.effects.empty()) diagnosis.stage = diagnosis.effects.front().stage;
}

/// The probability of an effect of an explanation or of one that the data cannot tell from it.
double probability_of(const Comparison& comparison, const Hypothesis& best, std::size_t effect, bool filmed) {
  std::vector<std::size_t> any = not_told_apart(comparison, best, effect, filmed);
  any.push_back(effect);
  return probability_of_any(comparison, any);
}

/// Whether the likeliest effect of an explanation, together with those that the data cannot tell from it, is likelier
/// than not. A name that is less likely is no answer.
bool is_likelier_than_not(const TrackSet& set, const Comparison& comparison, const Hypothesis& best) {
  return std::any_of(best.effects.begin(), best.effects.end(), [&](std::size_t e) {
    return probability_of(comparison, best, e, set.images) >= kLikelierThanNot;
  });
}

/// A fit that counts its own remainder as noise, the motions with that noise, and the remainder.
struct Sized {
  TrackSet set;
  MotionFit fit;
  RemainderSizes remainder = {};
};

/// The causes that keep their name, beside their own remainder, for the sizes that the verdict gives. The fit of the
/// whole explanation has other sizes: part of one cause may have gone into another that takes no part of the gap.
Sized sized_of(const TrackSet& set, const MotionFit& named) {
  Sized sized{set, {}, RemainderSpace(set, named).likeliest().sizes};
  add_remainder(named, sized.remainder, sized.set);
  sized.fit = fit_motions(sized.set, named.effects, named.at, named.late);
  if (!std::isfinite(sized.fit.cost)) sized.fit = linearise_again(sized.set, named);
  return sized;
}

/// Whether the size of one of these effects of a fit is larger than its standard deviation. Only sizes that all clips
/// have in common are looked at: others count as certain.
bool has_certain_size(const TrackSet& set, const MotionFit& fit, const std::vector<std::size_t>& effects) {
  const SizeUncertainty uncertainty(set, fit);
  const auto& globals = fit.layout->globals();
  return std::any_of(effects.begin(), effects.end(), [&](std::size_t e) {
    const EffectInfo& info = effect_list()[e];
    bool has_common = false;
    for (std::size_t g = 0; g < globals.size(); ++g) {
      if (globals[g].parameter == nullptr || globals[g].effect != e) continue;
      const std::size_t slot = globals[g].parameter->slot.parameter;
      const bool is_size = slot >= info.law.size && slot < info.law.size + info.law.sizes;
      if (!is_size || globals[g].parameter->each != Each::experiment || info.search == Search::spread) continue;
      const auto at = static_cast<Eigen::Index>(g);
      if (std::abs(fit.at.global[at]) > uncertainty.sd(at)) return true;
      has_common = true;
    }
    return !has_common;
  });
}

/// If some effects of an explanation have no certain size and others have, the explanation of the others alone: a drag
/// of size 0 beside a wrong frame rate is no cause. Null if there is no such fit.
const Hypothesis* with_certain_sizes(const TrackSet& set, const Comparison& comparison, const Hypothesis& best) {
  const MotionFit& fit = comparison.fits[static_cast<std::size_t>(best.fit)];
  std::set<std::size_t> certain;
  for (const std::size_t e : best.effects) {
    if (has_certain_size(set, fit, {e})) certain.insert(e);
  }
  if (certain.empty() || certain.size() == best.effects.size()) return nullptr;
  const Hypothesis* others = find(comparison, certain);
  return others != nullptr && others->fit > 0 ? others : nullptr;
}

/// If some of several causes do not take their part, the cause that is clearly likelier keeps its name, rather than the
/// one that takes most in place of both. Returns the explanation with that cause alone; null if the sequence names it
/// already, or if no fit has it alone.
const Hypothesis* without_the_lesser(const Comparison& comparison, bool filmed, const Hypothesis& best,
                                     const CauseSequence& sequence) {
  if (!sequence.is_gap || best.effects.size() < 2) return nullptr;
  const std::vector<std::size_t>& named = sequence.named.effects;
  std::size_t likeliest = best.effects.front();
  double most = 0.0, of_named = 0.0;
  for (const std::size_t e : best.effects) {
    const bool keeps = std::find(named.begin(), named.end(), e) != named.end();
    const double probability = probability_of(comparison, best, e, filmed);
    if (keeps) of_named = std::max(of_named, probability);
    if (keeps || probability <= most) continue;
    likeliest = e;
    most = probability;
  }
  if (most <= of_named + kClearlyLikelier || !shows_in_motion(effect_list()[likeliest].search)) return nullptr;
  const Hypothesis* alone = find(comparison, {likeliest});
  return alone != nullptr && alone->fit > 0 ? alone : nullptr;
}

constexpr double kLikely = 0.02;  // probability from which an explanation widens what is recovered
constexpr std::size_t kMostLikely = 6;

/// Adds the explanations other than the reported one, and to that one its probability. The nominal model stands for the
/// unknown.
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

/// The same by the noise alone, if nothing was weighed with a remainder.
void add_others(const Comparison& by_noise, const std::vector<Hypothesis>& all, Explanations& explanations) {
  for (const Hypothesis& one : all) {
    const bool fitted = !one.unnamed && !one.effects.empty() && one.fit > 0;
    const bool reported = fitted && one.effects == explanations.front().effects;
    if (!fitted || reported || one.probability < kLikely || explanations.size() > kMostLikely) continue;
    explanations.push_back({&by_noise.fits[static_cast<std::size_t>(one.fit)], {}, one.probability, one.effects});
    explanations.front().probability -= one.probability;
  }
}

/// The motions of each explanation as a scenario, for studies that record them again. Every scenario has the reported
/// effects of the camera.
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

/// The log evidence by which the positions alone prefer an explanation of a fall, a quadratic drag with or without the
/// inertia of the air, to a viscous drag with or without the same. Empty for other explanations.
std::optional<double> evidence_over_viscous(const Comparison& comparison, const Hypothesis& best) {
  const std::size_t drag = effect_index(ids::quadratic_drag);
  std::set<std::size_t> effects(best.effects.begin(), best.effects.end());
  if (effects.size() > 1 && !is_drag_with_its_air(best.effects)) return {};
  const Hypothesis* quadratic = find(comparison, effects);
  effects.erase(drag);
  const Hypothesis* viscous = find(comparison, effects);
  if (quadratic == nullptr || viscous == nullptr) return {};
  return quadratic->log_evidence - viscous->log_evidence;
}

/// The ratio of densities of fluid and body with which buoyancy would slow a fall as a named wrong scale or frame rate
/// does: g becomes (1 + e) g by the scale, and (1 + e)² g by the frame rate. Empty if none is named, or if it would be
/// no buoyancy: the fall is faster.
std::optional<double> ratio_of_densities(const Diagnosis& diagnosis) {
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    const bool of_rate = effect.id == ids::frame_rate_error;
    if (!of_rate && effect.id != ids::scale_error) continue;
    for (const DiagnosedParameter& parameter : effect.parameters) {
      const double factor = (1.0 + parameter.value) * (of_rate ? 1.0 + parameter.value : 1.0);
      if (parameter.key == "e" && factor < 1.0) return 1.0 - factor;
    }
  }
  return {};
}

/// Whether the nominal model has a gap and the likeliest explanation by the noise alone leaves one too, or leaves a
/// doubt although sizes of each clip or a second cause help it to follow the motion.
bool leaves_a_gap(const TrackSet& set, const Comparison& by_noise) {
  const MotionFit& nominal = by_noise.fits.front();
  if (!has_gap(set, nominal)) return false;
  const Hypothesis* best = best_named(set, by_noise);
  if (best == nullptr || best->fit <= 0) return true;
  const bool is_law = best->effects.size() == 1 && !follows_each_clip(best->effects.front());
  if (!is_law && by_noise.none + by_noise.unknown > kLeastDoubt) return true;
  return has_gap(set, by_noise.fits[static_cast<std::size_t>(best->fit)]);
}

}  // namespace

Diagnosis with_causes(const TrackSet& set, Comparison first, ImageEvidence images,
                      const std::vector<std::size_t>& left_out, int jobs, const base::Progress& progress) {
  const std::set<std::size_t> without(left_out.begin(), left_out.end());
  const MotionFit& nominal = first.fits.front();
  std::optional<WeighedCauses> weighed;
  if (first.unknown > kLeastUnknown || leaves_a_gap(set, first)) {
    weighed = weigh_causes(set, first, without, jobs, &images,
                           [&](double part) { progress("weighing explanations", 0.5 + 0.4 * part); });
  }
  progress("measuring the gap", 0.9);
  const std::vector<Hypothesis> all_before =
      weighed ? weighed->comparison.all : first.all;  // before the share changes the probabilities
  const double unknown = weighed ? weighed->comparison.none + weighed->comparison.unknown : first.none + first.unknown;
  const TrackSet& with = weighed ? weighed->set : set;
  std::optional<Hypothesis> helps;  // the best explanation, likely enough to be named or not
  if (weighed) {
    if (const Hypothesis* best = best_named(with, weighed->comparison)) helps = *best;
    move_minorities_to_unknown(weighed->comparison);
  }
  const Comparison& by = weighed ? weighed->comparison : first;
  // Beside a remainder, `none` counts as unknown: there is a gap.
  const bool claims =
      verdict_by(weighed ? 0.0 : by.none, weighed ? by.none + by.unknown : by.unknown) == Verdict::effect;
  const Hypothesis* found = claims || !helps ? best_named(with, by) : &*helps;
  const bool names = found != nullptr && found->fit > 0 && (weighed || claims);
  Hypothesis best = names ? *found : Hypothesis{};  // the comparison's own order changes below
  if (const Hypothesis* sized = names && weighed ? with_certain_sizes(with, by, best) : nullptr) best = *sized;
  const auto fit_of = [&](const Hypothesis& one) -> const MotionFit& {
    return names ? by.fits[static_cast<std::size_t>(one.fit)] : nominal;
  };
  const double least_named = weighed ? kLeastNamed : 0.0;
  // K of the nominal model imitates a drag of air. The gap that such a drag explains is that of a fall without any.
  const bool by_air = set.through_air && claims && names && has(best, effect_index(ids::quadratic_drag));
  const std::optional<double> over_viscous = by_air ? evidence_over_viscous(by, best) : std::nullopt;
  const TrackSet gap_set = by_air ? without_drag(set) : set, gap_with = by_air ? without_drag(with) : with;
  const MotionFit gap_nominal = by_air ? fit_nominal(gap_set) : nominal;
  const auto sequence_with = [&](const Hypothesis& one) {
    return sequence_of(gap_set, gap_nominal, gap_with, fit_of(one), without, least_named);
  };
  CauseSequence sequence;
  const Hypothesis* likely = names && weighed && claims ? likely_part(set, by, best) : nullptr;
  if (likely != nullptr) sequence = sequence_with(*likely);
  if (likely != nullptr && sequence.named_share >= kHalfOfGap && is_likelier_than_not(with, by, *likely)) {
    best = *likely;
  } else {
    sequence = sequence_with(best);
  }
  if (const Hypothesis* alone = weighed && claims ? without_the_lesser(by, set.images, best, sequence) : nullptr) {
    CauseSequence likelier = sequence_with(*alone);
    if (may_displace(likelier, sequence)) {
      best = *alone;
      sequence = std::move(likelier);
    }
  }
  const MotionFit& fit = fit_of(best);
  const bool in_images = names ? shows_in_images(best) : found != nullptr && shows_in_images(*found);
  // Scatter has no fit of its own: the verdict on it is by the noise alone.
  const bool scatter = found != nullptr && is_scatter_alone(*found) && claims;
  const std::vector<std::size_t> named = names || scatter ? found->effects : std::vector<std::size_t>();
  Diagnosis diagnosis;
  std::vector<std::string> traces;
  // Without a gap nothing remains, and an effect without a name shows best against the noise alone.
  const bool settled = weighed && sequence.is_gap && names;
  if (settled) hold_to_share(sequence, best.effects, by_air, weighed->comparison);
  if (settled && !is_likelier_than_not(with, by, best)) {
    set_unknown(std::max(by.unknown, kUnknownIfLess), weighed->comparison);
  }
  const MotionFit& of_gap = sequence.named.effects.empty() ? fit : sequence.named;
  const Sized sized = settled ? sized_of(set, of_gap) : Sized{with, fit};
  // A name is not confident if its effect may as well have no size at all.
  const bool open_size =
      names && sequence.is_gap && shows_in_gap(best) && !has_certain_size(sized.set, sized.fit, of_gap.effects);
  if (settled && open_size) set_unknown(std::max(by.unknown, kOpenSize), weighed->comparison);
  if (settled && verdict_by(by.none, by.unknown) == Verdict::effect) {
    const NoiseAlone noise_alone{gap_set, gap_nominal, sequence.named, sized.set, sized.fit};
    diagnosis = verdict_of(with, by, std::move(images), &noise_alone);
  } else {
    // Nothing is claimed below the step of rounding: what shows there and leaves no gap comes from rounding. Nor is
    // anything claimed if the positions follow the model far better than the assumed noise allows.
    const bool not_measured = noise_is_rounding(set) || sequence.gap_before < kLeastMeasuredGap;
    const bool below_noise = not_measured && !sequence.is_gap && !in_images;
    if (below_noise) {
      move_to_none([](const Hypothesis&) { return true; }, first);
      first.none += std::exchange(first.unknown, 0.0);
    }
    // A name that takes less than half of a gap does not explain it.
    const bool explains = !names || !shows_in_gap(best) || sequence.named_share >= kHalfOfGap;
    if (!weighed && sequence.is_gap && !explains) set_unknown(1.0, first);
    if (!weighed && sequence.is_gap && names && shows_in_gap(best) && !in_images &&
        !is_likelier_than_not(set, first, best)) {
      set_unknown(std::max(first.unknown, kUnknownIfLess), first);
    }
    if (!weighed && open_size && !in_images) set_unknown(std::max(first.unknown, kOpenSize), first);
    if (weighed && sequence.is_gap && !in_images) {
      // Nothing that moves the glider explains the gap.
      first.unknown += std::exchange(first.none, 0.0);
      set_unknown(std::max(by.none + by.unknown, kUnknownIfLess), first);
    }
    // Without a gap, a name must do more than small imperfections would. Scatter of single positions shifts no
    // parameter either: unless it is all but certain, it is a trace.
    if (!weighed && !sequence.is_gap && !below_noise && !named.empty()) {
      if (names && shows_in_gap(best)) allow_for_remainders(set, without, jobs, first);
      if (scatter && probability_of_scatter(first) < kSureScatter) move_to_none(is_scatter_alone, first);
      if ((scatter || shows_in_gap(best)) && verdict_by(first.none, first.unknown) == Verdict::none) {
        for (const std::size_t e : named) traces.emplace_back(effect_list()[e].id);
      }
    }
    const NoiseAlone noise_alone{gap_set, gap_nominal, sequence.named, sized.set, sized.fit};
    diagnosis = verdict_of(set, first, std::move(images), by_air && sequence.is_gap ? &noise_alone : nullptr);
    if (weighed && sequence.is_gap && !in_images) {
      const NoiseAlone noise{set, nominal, nominal, set, nominal};
      diagnosis.ranking = ranking_of(with, by, &noise);
    }
  }
  if (noise_is_rounding(set)) traces.emplace_back(ids::position_rounding);
  diagnosis.traces = std::move(traces);
  diagnosis.explained = diagnosis.verdict == Verdict::unknown ? helpful(sequence.causes) : sequence.causes;
  order_by_share(by_air, diagnosis);
  // Where causes are named whatever part of the gap they take, all of them are in the fit of the explanation itself.
  const MotionFit& with_effect = sequence.is_gap && (settled || by_air) ? sequence.named : fit;
  const MotionFit& reported = diagnosis.verdict == Verdict::effect ? with_effect : nominal;
  const RemainderSpace space(set, reported);
  const bool is_sized = settled && &reported == &of_gap;
  const RemainderSizes sizes = is_sized ? sized.remainder : space.likeliest().sizes;
  if (sequence.is_gap) {
    diagnosis.remainder = remainder_of(sequence.gap_before, diagnosis.explained, sizes, space.part_s());
    diagnosis.remainder->regions =
        diagnosis.verdict == Verdict::effect ? regions_beside(set, sequence, jobs) : diagnosis.regions;
  }
  diagnosis.levels = levels_of(gap_set, gap_nominal, jobs);
  if (by_air) diagnosis.notes.emplace_back(FallsThroughAir{over_viscous});
  constexpr double kLeastRatio = 0.01;  // air has 0.001 of the density of what falls through it, or less
  if (const std::optional<double> ratio = only_falls(set) ? ratio_of_densities(diagnosis) : std::nullopt;
      ratio && *ratio > kLeastRatio) {
    diagnosis.notes.emplace_back(BuoyancyLooksAlike{*ratio});
  }
  Explanations explanations{{&reported, sizes, 1.0}};
  if (weighed) {
    const bool with_names = diagnosis.verdict == Verdict::effect;
    explanations.front().probability = with_names ? 0.0 : unknown;
    add_others(*weighed, all_before, unknown, with_names ? best.effects : std::vector<std::size_t>(), explanations);
    explanations.front().probability = std::max(explanations.front().probability, kLikely);
  }
  if (diagnosis.verdict == Verdict::effect) explanations.front().effects = best.effects;
  if (!weighed) add_others(first, all_before, explanations);
  diagnosis.recovered = recovered_of(set, explanations);
  diagnosis.likely_twins = likely_twins(set, explanations, diagnosis.effects);
  if (set.clips.size() < 2) cap_probabilities(kMostOfOneClip, diagnosis);
  return diagnosis;
}

}  // namespace glidelab::diagnose
