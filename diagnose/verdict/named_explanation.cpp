#include "diagnose/verdict/named_explanation.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <set>

#include "diagnose/causes/cause_odds.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/gap/size_uncertainty.h"
#include "diagnose/verdict/verdict.h"

namespace glidelab::diagnose {
namespace {

// Probability from which a cause counts together with others that do the same in these data alone: one of three at
// most. A name that is spread over more of them says little, and of made experiments' ones hardly any is true.
constexpr double kLikelyAmongEquals = 1.0 / 3.0;
// An explanation that takes another's place because it has a certain size has this part of its probability or more.
constexpr double kAboutAsLikely = 1.0 / 3.0;
constexpr double kClearlyLikelier = 0.1;  // difference of probability: a smaller one is no reason to name another cause

/// Whether both are one law with other constants: a quadratic drag is a power law of exponent 2.
bool is_same_law(std::size_t one, std::size_t other) {
  const auto is_of_air = [](std::size_t e) { return effect_list()[e].drag == Drag::of_air; };
  return one != other && is_of_air(one) && is_of_air(other);
}

/// The same without the other causes of the explanation, and only with those that no track can tell from it or that are
/// the same law: what else could stand beside those other causes does not make it likelier alone.
double probability_alone(const Comparison& comparison, const Hypothesis& best, std::size_t effect, bool filmed) {
  std::vector<std::size_t> any = {effect};
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    if (has(best, e)) continue;
    if (are_alike(comparison, e, effect, filmed) || is_same_law(e, effect)) any.push_back(e);
  }
  return probability_of_any(comparison, any);
}

}  // namespace

bool shows_in_images_alone(const Hypothesis& explanation) {
  bool in_images = false;
  for (const std::size_t e : explanation.effects) {
    if (takes_part_of_gap(effect_list()[e].search)) return false;
    in_images = in_images || effect_list()[e].search == Search::images;
  }
  return in_images;
}

bool is_likelier_than_not(const TrackSet& set, const Comparison& comparison, const Hypothesis& best,
                          const Hypothesis* part_of) {
  return std::any_of(best.effects.begin(), best.effects.end(), [&](std::size_t e) {
    std::vector<std::size_t> any = not_told_apart(comparison, best, e, set.images);
    if (part_of != nullptr && has(*part_of, e)) {
      for (const std::size_t other : not_told_apart(comparison, *part_of, e, set.images)) {
        if (!has(best, other)) any.push_back(other);
      }
    }
    any.push_back(e);
    return probability_of_any(comparison, any) >= kLikelierThanNot;
  });
}

namespace {

/// Each of these effects, or the likelier one that these data cannot tell from it: `best` has its names from the
/// likeliest pair, and another name may be likelier without the second of them.
std::set<std::size_t> by_likeliest_names(const TrackSet& set, const Comparison& comparison,
                                         const std::set<std::size_t>& effects) {
  std::set<std::size_t> names;
  for (const std::size_t e : effects) {
    std::size_t name = e;
    for (std::size_t other = 0; other < effect_list().size(); ++other) {
      if (effects.contains(other) || !are_alike(comparison, other, e, set.images)) continue;
      if (comparison.effect_probability[other] > comparison.effect_probability[name] + kClearlyLikelier) name = other;
    }
    names.insert(name);
  }
  return names;
}

}  // namespace

const Hypothesis* likely_part(const TrackSet& set, const Comparison& comparison, const Hypothesis& best) {
  const auto probability = [&](std::size_t effect) {
    const auto alike = [&](std::size_t other) { return are_alike(comparison, other, effect, set.images); };
    if (std::count_if(best.effects.begin(), best.effects.end(), alike) > 1) {
      return comparison.effect_probability[effect];
    }
    std::vector<std::size_t> any;
    if (probability_of_any(comparison, {effect}) >= kLikelyAmongEquals) {
      any = not_told_apart(comparison, best, effect, set.images);
    }
    for (std::size_t e = 0; e < effect_list().size(); ++e) {
      if (e == effect || alike(e)) any.push_back(e);
    }
    return probability_of_any(comparison, any);
  };
  std::set<std::size_t> likely;
  std::size_t likeliest = best.effects.front();
  double most = 0.0;
  for (const std::size_t e : best.effects) {
    const double of_this = probability(e);
    if (of_this >= kLikelierThanNot) likely.insert(e);
    if (of_this > most) likeliest = e;
    most = std::max(most, of_this);
  }
  likely.insert(likeliest);
  if (likely.size() == best.effects.size()) return nullptr;
  const auto fitted = [&](const std::set<std::size_t>& effects) {
    const Hypothesis* found = find(comparison, effects);
    return found != nullptr && found->fit > 0 ? found : nullptr;
  };
  const Hypothesis* renamed = fitted(by_likeliest_names(set, comparison, likely));
  return renamed != nullptr ? renamed : fitted(likely);
}

bool has_certain_size(const TrackSet& set, const MotionFit& fit, const std::vector<std::size_t>& effects,
                      double least_sd) {
  constexpr double kByChance = 0.01;  // that sizes which are all 0 are together so far from it
  const SizeUncertainty uncertainty(set, fit);
  const auto& globals = fit.layout->globals();
  return std::any_of(effects.begin(), effects.end(), [&](std::size_t e) {
    const EffectInfo& info = effect_list()[e];
    bool has_common = false;
    std::vector<Eigen::Index> several;
    for (std::size_t g = 0; g < globals.size(); ++g) {
      if (globals[g].parameter == nullptr || globals[g].effect != e) continue;
      const std::size_t slot = globals[g].parameter->slot.parameter;
      const bool is_size = slot >= info.law.size && slot < info.law.size + info.law.sizes;
      const auto at = static_cast<Eigen::Index>(g);
      if (info.search == Search::spread) {
        several.push_back(at);
        continue;
      }
      if (!is_size || globals[g].parameter->each != Each::experiment) continue;
      if (std::abs(fit.at.global[at]) > least_sd * uncertainty.sd(at)) return true;
      has_common = true;
    }
    if (!several.empty() && !follows_each_clip(e)) {
      const boost::math::chi_squared by_chance(static_cast<double>(several.size()));
      return uncertainty.chi2(several, fit.at.global(several)) >
             boost::math::quantile(boost::math::complement(by_chance, kByChance));
    }
    return !has_common;
  });
}

bool leaves_quantities(const TrackSet& set, const MotionFit& nominal, const MotionFit& with) {
  constexpr double kWithin = 2.0;  // standard deviations
  using Global = ParameterLayout::Global;
  const SizeUncertainty before(set, nominal), after(set, with);
  const auto &globals = nominal.layout->globals(), &others = with.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    using enum Global::Kind;
    if (globals[g].kind != k && globals[g].kind != mu && globals[g].kind != alpha) continue;
    const auto other =
        std::ranges::find_if(others, [&](const Global& one) { return ParameterLayout::same(one, globals[g]); });
    if (other == others.end()) continue;
    const auto at = static_cast<Eigen::Index>(g), to = static_cast<Eigen::Index>(other - others.begin());
    const double sd = std::max(before.sd(at), after.sd(to));
    if (std::abs(with.at.global[to] - nominal.at.global[at]) > kWithin * sd) return false;
  }
  return true;
}

bool is_function_without_size(const TrackSet& set, const MotionFit& fit, std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  return info.search == Search::spread && info.parameters.front().each == Each::experiment &&
         !has_certain_size(set, fit, {effect});
}

const Hypothesis* part_with_sizes(const TrackSet& set, const MotionFit& fit, const Comparison& comparison) {
  if (!fit.late.empty()) return nullptr;  // lost frames are in the times, and not among the effects
  std::set<std::size_t> sized;
  for (const std::size_t e : fit.effects) {
    if (has_certain_size(set, fit, {e})) sized.insert(e);
  }
  if (sized.empty() || sized.size() == fit.effects.size()) return nullptr;
  const Hypothesis* found = find(comparison, sized);
  return found != nullptr && found->fit > 0 ? found : nullptr;
}

namespace {

/// Whether an explanation leaves about as little of the gap as another: what it lacks is no cause of the gap.
bool leaves_no_more(const Hypothesis& without, const Hypothesis& with) {
  constexpr double kPartOfCause = 0.1;  // of the excess
  return !without.left || !with.left || *without.left < *with.left + kPartOfCause;
}

/// The likeliest explanation in which another effect, one that the data cannot tell from it, has a certain size in
/// place of an effect without one, if it is about as likely; null if there is none.
const Hypothesis* with_size_by_another_name(const TrackSet& set, const Comparison& comparison, const Hypothesis& best,
                                            std::size_t without_size) {
  const Hypothesis* likeliest = nullptr;
  for (const std::size_t other : not_told_apart(comparison, best, without_size, set.images)) {
    std::set<std::size_t> effects(best.effects.begin(), best.effects.end());
    effects.erase(without_size);
    effects.insert(other);
    const Hypothesis* renamed = find(comparison, effects);
    if (renamed == nullptr || renamed->fit <= 0 || renamed->probability < kAboutAsLikely * best.probability) continue;
    if (!has_certain_size(set, comparison.fits[static_cast<std::size_t>(renamed->fit)], {other})) continue;
    if (likeliest == nullptr || renamed->probability > likeliest->probability) likeliest = renamed;
  }
  return likeliest;
}

}  // namespace

const Hypothesis* with_certain_sizes(const TrackSet& set, const Comparison& comparison, const Hypothesis& best) {
  const auto without_size = [&](const Hypothesis& of) {
    std::vector<std::size_t> effects;
    for (const std::size_t e : of.effects) {
      if (!has_certain_size(set, comparison.fits[static_cast<std::size_t>(of.fit)], {e})) effects.push_back(e);
    }
    return effects;
  };
  const Hypothesis* renamed = nullptr;
  std::vector<std::size_t> uncertain = without_size(best);
  for (std::size_t left = best.effects.size(); left > 0 && !uncertain.empty(); --left) {
    const Hypothesis* next = nullptr;
    for (const std::size_t e : uncertain) {
      next = with_size_by_another_name(set, comparison, renamed != nullptr ? *renamed : best, e);
      if (next != nullptr) break;
    }
    if (next == nullptr) break;
    renamed = next;
    uncertain = without_size(*renamed);
  }
  const Hypothesis& named = renamed != nullptr ? *renamed : best;
  if (uncertain.empty() || uncertain.size() == named.effects.size()) return renamed;
  std::set<std::size_t> certain(named.effects.begin(), named.effects.end());
  for (const std::size_t e : uncertain) certain.erase(e);
  // A size may be uncertain because sizes of each clip can do the same: the law is then no less likely than without.
  const auto most = [&](const auto& effects) {
    double likeliest = 0.0;
    for (const std::size_t e : effects) {
      std::vector<std::size_t> any;  // its names
      for (std::size_t other = 0; other < effect_list().size(); ++other) {
        if (other == e || are_alike(comparison, other, e, set.images)) any.push_back(other);
      }
      likeliest = std::max(likeliest, probability_of_any(comparison, any));
    }
    return likeliest;
  };
  if (most(uncertain) > most(certain) + kClearlyLikelier) return renamed;
  const Hypothesis* others = find(comparison, certain);
  return others != nullptr && others->fit > 0 && leaves_no_more(*others, named) ? others : renamed;
}

const Hypothesis* without_the_lesser(const Comparison& comparison, bool filmed, const Hypothesis& best,
                                     const CauseSequence& sequence) {
  if (!sequence.is_gap || best.effects.size() < 2) return nullptr;
  const std::vector<std::size_t>& named = sequence.named.effects;
  std::size_t likeliest = best.effects.front();
  double most = 0.0, of_named = 0.0;
  for (const std::size_t e : best.effects) {
    const bool keeps = std::find(named.begin(), named.end(), e) != named.end();
    const double probability = probability_alone(comparison, best, e, filmed);
    if (keeps) of_named = std::max(of_named, probability);
    if (keeps || probability <= most) continue;
    likeliest = e;
    most = probability;
  }
  if (most <= of_named + kClearlyLikelier || !shows_in_motion(effect_list()[likeliest].search)) return nullptr;
  const Hypothesis* alone = find(comparison, {likeliest});
  return alone != nullptr && alone->fit > 0 ? alone : nullptr;
}

bool has_evidence(const Comparison& comparison, std::size_t effect, bool filmed) {
  if (differs_between_clips(effect)) return true;  // the nominal remainder contains it
  return std::any_of(comparison.all.begin(), comparison.all.end(), [&](const Hypothesis& one) {
    return !one.unnamed && one.log_evidence > 0.0 && std::any_of(one.effects.begin(), one.effects.end(), [&](auto e) {
      return e == effect || are_alike(comparison, e, effect, filmed);
    });
  });
}

bool may_lead(const BesideRemainder& sized, const Comparison& comparison, const CauseSequence& sequence) {
  constexpr double kClearOfZero = 2.0;  // standard deviations
  const std::vector<std::size_t>& named = sequence.named.effects;
  if (named.empty() || (!sequence.causes.empty() && sequence.causes.front().id == ids::dropped_frames)) return true;
  const bool no_noise = sequence.gap_before * sequence.gap_before - 1.0 >= kLargestExcess;
  const auto takes_little = [&](std::size_t e) {
    constexpr double kLittle = 0.1;  // of the gap
    return std::ranges::any_of(sequence.causes, [&](const ExplainedCause& cause) {
      return cause.id == effect_list()[e].id && cause.share < kLittle;
    });
  };
  const auto is_open_ended = [](std::size_t e) {  // a hard stop may be as stiff as it likes
    return std::ranges::any_of(effect_list()[e].parameters, &EffectParameter::open_ended);
  };
  return std::any_of(named.begin(), named.end(), [&](std::size_t e) {
    if (takes_little(e)) return false;
    if (e != named.front() && differs_between_clips(e)) return false;  // beside a law scatter proves nothing
    return (no_noise || has_evidence(comparison, e, sized.set.images)) &&
           (is_open_ended(e) || has_certain_size(sized.set, sized.fit, {e}, kClearOfZero));
  });
}

const Hypothesis& named_by(const Comparison& comparison, const CauseSequence& sequence, const Hypothesis& best) {
  const std::vector<std::size_t>& effects = sequence.named.effects;
  const Hypothesis* named = effects.empty() ? nullptr : find(comparison, {effects.begin(), effects.end()});
  return named != nullptr ? *named : best;
}

bool viscous_leaves_less(const TrackSet& set, const Comparison& comparison, std::optional<double> over_viscous) {
  const std::size_t drag = effect_index(ids::quadratic_drag);
  const auto has_other_law = [&](const Hypothesis& one) {
    return std::any_of(one.effects.begin(), one.effects.end(),
                       [&](std::size_t e) { return e != drag && effect_list()[e].drag == Drag::of_air; });
  };
  const auto touches = [](const Hypothesis& one) {
    return std::any_of(one.effects.begin(), one.effects.end(),
                       [](std::size_t e) { return effect_list()[e].touch == Touch::in_one_place; });
  };
  const Hypothesis *viscous = nullptr, *quadratic = nullptr;
  for (const Hypothesis& one : comparison.all) {
    if (one.unnamed || one.fit < 0 || !one.converged || has_other_law(one)) continue;
    if (!has(one, drag) && touches(one)) continue;
    const Hypothesis*& best = has(one, drag) ? quadratic : viscous;
    if (best == nullptr || one.log_evidence > best->log_evidence) best = &one;
  }
  constexpr double kClearly = 2.3;  // log evidence: ten to one
  if (viscous == nullptr || quadratic == nullptr) return false;
  if (viscous->log_evidence < quadratic->log_evidence + kClearly) return false;
  const auto gap_of = [&](const Hypothesis& one) {
    const MotionFit& fit = comparison.fits[static_cast<std::size_t>(one.fit)];
    return held_out_gap(set, fit_motions(set, fit.effects, fit.at, fit.late)).value;
  };
  return FallsThroughAir{over_viscous, FallsThroughAir::Gaps{gap_of(*viscous), gap_of(*quadratic)}}
      .viscous_leaves_less();
}

}  // namespace glidelab::diagnose
