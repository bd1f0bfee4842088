#include "diagnose/next/next_experiment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/next/expected_evidence.h"
#include "diagnose/next/next_changes.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {
namespace {

/// Of the launches with the masses and set-ups so far, the one with most positions for which `inside` is true; none if
/// no launch has any.
std::optional<CoverRegion> best_cover(const TrackSet& set, const MotionFit& nominal, CoverRegion::Over over,
                                      const GapRegion& region, const std::function<bool(double, double)>& inside) {
  CoverRegion best;
  best.over = over;
  best.from = region.from;
  best.to = region.to;
  for (const Change& change : feasible_changes(set, nominal)) {
    if (change.kind != ChangeKind::launch) continue;
    ++best.launches;
    const Moved clip = next_motion(set, nominal, change).moved;
    std::size_t count = 0;
    for (std::size_t p = 0; p < clip.x_m.size(); ++p) count += inside(clip.x_m[p], clip.v_m_s[p]) ? 1 : 0;
    if (count <= best.inside) continue;
    best.inside = count;
    best.positions = clip.x_m.size();
    best.launch = change;
  }
  constexpr std::size_t kFewest = 5;  // a launch with fewer positions there shows little of it
  return best.inside >= kFewest ? std::optional(best) : std::nullopt;
}

/// A mass in the middle of the widest gap between masses, or well above the heaviest.
AddMass mass_between(const TrackSet& set) {
  std::vector<double> masses;
  for (const TrackedMass& mass : set.masses) masses.push_back(mass.mass_kg);
  std::sort(masses.begin(), masses.end());
  double next = 1.6 * masses.back(), widest = 1.0;
  for (std::size_t m = 1; m < masses.size(); ++m) {
    const double apart = masses[m] / masses[m - 1];
    if (apart <= widest) continue;
    widest = apart;
    next = 0.5 * (masses[m] + masses[m - 1]);
  }
  return {next, set.mass_assumed};
}

}  // namespace

NextStep next_for_unnamed(const TrackSet& set, const MotionFit& nominal, const Diagnosis& diagnosis) {
  if (diagnosis.regions.empty()) return Routine::repeat_launch;
  const GapRegion& region = diagnosis.regions.front();
  const GapVariable variable = region.variable;
  if (!region.clip.empty()) return RepeatClip{region.clip};
  if (is_driven(set) && (variable == GapVariable::position || variable == GapVariable::speed))
    return Routine::other_forces;
  if (variable == GapVariable::position) {
    const auto cover = best_cover(set, nominal, CoverRegion::Over::places, region,
                                  [&](double x, double) { return x >= region.from && x <= region.to; });
    if (cover) return *cover;
    return Routine::move_camera;
  }
  if (variable == GapVariable::speed) {
    const bool of_speed = region.what == GapKind::friction;  // whichever way it moves
    const auto cover = best_cover(set, nominal, CoverRegion::Over::speeds, region, [&](double, double v) {
      const double at = of_speed ? std::abs(v) : v;
      return at >= region.from && at <= region.to;
    });
    if (cover) return *cover;
    return Routine::other_speeds;
  }
  if (variable == GapVariable::mass) return mass_between(set);
  if (variable == GapVariable::time) return Routine::start_later;
  if (variable == GapVariable::direction) return Routine::turn_glider;
  if (variable == GapVariable::set_up) return Routine::set_up_again;
  if (variable == GapVariable::column || variable == GapVariable::row) return Routine::move_camera;
  return Routine::repeat_launch;
}

namespace {

constexpr double kLeastDecisiveGain = 5.0;  // expected log likelihood above which a change is worth making
constexpr double kStillLikely = 0.05;       // probability above which an explanation is a rival
constexpr std::size_t kMostRivals = 3;
constexpr double kLargestFriction = 1.0;  // mu of most pairs of surfaces: a larger sd says nothing
constexpr double kSharpens = 0.95;        // of the standard deviation so far: a clip that leaves more is not worth it

bool holds(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::vector<std::string> only_in(const Hypothesis& a, const Hypothesis& b) {
  std::vector<std::string> ids;
  for (const std::size_t e : a.effects) {
    if (std::find(b.effects.begin(), b.effects.end(), e) == b.effects.end()) {
      ids.emplace_back(effect_list()[e].id);
    }
  }
  return ids;
}

/// Whether the diagnosis says that these data cannot tell an effect of the leading explanation from another.
bool equivalent(const Diagnosis& diagnosis, const std::vector<std::string>& lacks,
                const std::vector<std::string>& adds) {
  if (lacks.size() != 1 || adds.size() != 1) return false;
  return std::any_of(diagnosis.effects.begin(), diagnosis.effects.end(), [&](const DiagnosedEffect& effect) {
    return effect.id == lacks.front() && holds(effect.equivalent_to, adds.front());
  });
}

/// The explanation by the effects that the verdict names, or by those of them that a motion shows; the comparison's
/// best if no fit has exactly these.
const Hypothesis* with_the_named(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis) {
  std::set<std::size_t> named, moving;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    const std::size_t e = effect_index(effect.id);
    named.insert(e);
    if (shows_in_motion(effect_list()[e].search)) moving.insert(e);
  }
  for (const std::set<std::size_t>& effects : {named, moving}) {
    const Hypothesis* found = effects.empty() ? nullptr : find(comparison, effects);
    if (found != nullptr) return found;
  }
  return best_named(set, comparison);
}

const Hypothesis* leading(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis) {
  if (diagnosis.verdict == Verdict::effect) return with_the_named(set, comparison, diagnosis);
  for (const Hypothesis& hypothesis : comparison.all) {
    if (!hypothesis.unnamed && hypothesis.effects.empty()) return &hypothesis;
  }
  return nullptr;
}

/// What may be in place of the leading explanation: without `lacks`, with `adds`; the likeliest explanation of the
/// kind.
struct Rival {
  const Hypothesis* by = nullptr;
  std::vector<std::string> lacks, adds;
  double probability = 0.0;  ///< of all explanations of the kind
  bool equivalent = false;

  bool counts() const { return probability >= kStillLikely || equivalent; }
};

/// Likeliest first. What an effect may replace or join is counted over all explanations with that effect, because the
/// probability of one cause may be shared among many second ones.
std::vector<Rival> rivals_of(const Comparison& comparison, const Diagnosis& diagnosis, const Hypothesis& first) {
  std::map<std::pair<std::vector<std::string>, std::string>, Rival> kinds;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.unnamed) continue;
    const std::vector<std::string> lacks = only_in(first, hypothesis), adds = only_in(hypothesis, first);
    if (lacks.empty() && adds.empty()) continue;
    for (const std::string& id : adds.empty() ? std::vector<std::string>{""} : adds) {
      Rival& kind = kinds.try_emplace({lacks, id}, Rival{&hypothesis, lacks, adds, 0.0, false}).first->second;
      kind.probability += hypothesis.probability;
      kind.equivalent |= equivalent(diagnosis, lacks, adds);
    }
  }
  std::vector<Rival> rivals;
  for (const auto& [key, kind] : kinds) {
    if (kind.counts()) rivals.push_back(kind);
  }
  std::stable_sort(rivals.begin(), rivals.end(),
                   [](const Rival& a, const Rival& b) { return a.probability > b.probability; });
  std::vector<Rival> distinct;
  for (Rival& rival : rivals) {
    const bool known =
        std::any_of(distinct.begin(), distinct.end(), [&](const Rival& of) { return of.by == rival.by; });
    if (known || distinct.size() == kMostRivals) continue;
    // An effect that is itself unlikely is no part of what is in doubt.
    std::erase_if(rival.adds, [&](const std::string& id) { return !kinds.at({rival.lacks, id}).counts(); });
    distinct.push_back(std::move(rival));
  }
  return distinct;
}

const MotionFit* fit_of(const Comparison& comparison, const Hypothesis& of) {
  return of.fit < 0 ? nullptr : &comparison.fits[static_cast<std::size_t>(of.fit)];
}

/// Two explanations, one of which is assumed to be right: the one with the effect that the other lacks, because an
/// absent effect shows nothing.
struct Contest {
  const Hypothesis *right, *other;
  Alternative doubt;
  double probability = 0.0;  // of the rival

  Contest(const Hypothesis& first, const Rival& rival)
      : right(&first), other(rival.by), doubt{{rival.lacks}, {rival.adds}}, probability(rival.probability) {
    if (!rival.lacks.empty()) return;
    std::swap(right, other);
    std::swap(doubt.one, doubt.other);
  }
};

/// Whether each rival is the leading explanation plus something else: no named effect is then in doubt.
bool only_add(const Hypothesis& first, const std::vector<Contest>& contests) {
  return std::all_of(contests.begin(), contests.end(), [&](const Contest& contest) { return contest.other == &first; });
}

std::vector<Alternative> alternatives(const std::vector<Contest>& contests) {
  std::vector<Alternative> doubt;
  for (const Contest& contest : contests) doubt.push_back(contest.doubt);
  return doubt;
}

struct Choice {
  const Change* change = nullptr;
  double gain = 0.0;
};

/// The change that reduces the odds of all rivals together most: by exp(gain).
Choice choose(const TrackSet& set, const Comparison& comparison, const std::vector<Contest>& contests,
              const std::vector<Change>& changes) {
  std::vector<Eigen::MatrixXd> covariances;
  double odds = 0.0;
  for (const Contest& contest : contests) {
    covariances.push_back(common_covariance(*fit_of(comparison, *contest.other)));
    odds += contest.probability;
  }
  Choice best;
  for (const Change& change : changes) {
    std::vector<double> gains;
    for (std::size_t c = 0; c < contests.size(); ++c) {
      const MotionFit &right = *fit_of(comparison, *contests[c].right),
                      &other = *fit_of(comparison, *contests[c].other);
      gains.push_back(expected_split(set, right, other, covariances[c], change));
    }
    const double least = *std::min_element(gains.begin(), gains.end());
    double left = 0.0;
    for (std::size_t c = 0; c < gains.size(); ++c) left += contests[c].probability / odds * std::exp(least - gains[c]);
    const double gain = least - std::log(left);
    if (std::isfinite(gain) && gain > best.gain) best = {&change, gain};
  }
  return best;
}

/// The change that tells the leading explanation from its rivals, or otherwise from the likeliest of them.
SettleDoubt settle(const TrackSet& set, const Comparison& comparison, std::vector<Contest> contests) {
  const std::vector<Change> changes = feasible_changes(set, comparison.fits.front());
  Choice best = choose(set, comparison, contests, changes);
  if (contests.size() > 1 && best.gain < kLeastDecisiveGain) {
    contests.erase(contests.begin() + 1, contests.end());
    best = choose(set, comparison, contests, changes);
  }
  SettleDoubt step{alternatives(contests), {}, weighed(changes), best.gain};
  if (best.change != nullptr && best.gain >= kLeastDecisiveGain) step.by = *best.change;
  return step;
}

/// A parameter of a fit: its name, its index among the common ones, its size, and the size by what is fitted.
struct Weak {
  std::string key, effect;
  Eigen::Index at = 0;
  double value = 0.0, by_member = 1.0;
};

/// The parameters that the explanation names; for the nominal model, K and mu, unless they are held at 0.
std::vector<Weak> named_parameters(const TrackSet& set, const MotionFit& fit) {
  std::vector<Weak> named;
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    const auto at = static_cast<Eigen::Index>(g);
    if (globals[g].parameter == nullptr || globals[g].parameter->key.empty()) continue;
    if (shown_together(globals[g].parameter->shown_as)) continue;
    const ShownValue value = shown(*globals[g].parameter, fit.at.global[at]);
    if (!std::isfinite(value.value)) continue;  // a v_c that fits best where it is absent
    named.push_back({std::string(globals[g].parameter->key), std::string(effect_list()[globals[g].effect].id), at,
                     value.value, value.by_fitted});
  }
  if (!named.empty()) return named;
  if (!holds_drag(set, fit.effects)) named.push_back({"K", "", 0, fit.at.global[0], 1.0});
  if (!only_falls(set)) named.push_back({"mu", "", 1, fit.at.global[1], 1.0});
  return named;
}

/// The parameter of an explanation without a rival that could be known better; none if all are held.
std::optional<SharpenParameter> sharpen(const TrackSet& set, const Comparison& comparison, const MotionFit& fit) {
  const Eigen::MatrixXd before = common_covariance(fit);
  const auto sd_of = [](const Weak& weak, const Eigen::MatrixXd& covariance) {
    return std::sqrt(std::max(0.0, covariance(weak.at, weak.at))) * std::abs(weak.by_member);
  };
  std::vector<Weak> named = named_parameters(set, fit);
  // Motions of one direction do not determine mu, and its row among the recovered values says so.
  std::erase_if(named, [&](const Weak& weak) {
    return weak.effect.empty() && weak.key == "mu" && !(sd_of(weak, before) < kLargestFriction);
  });
  if (named.empty()) return {};
  const Weak& weak = *std::max_element(named.begin(), named.end(), [&](const Weak& a, const Weak& b) {
    return sd_of(a, before) * std::abs(b.value) < sd_of(b, before) * std::abs(a.value);
  });
  const double sd = sd_of(weak, before);
  const std::vector<Change> changes = feasible_changes(set, comparison.fits.front());
  double best = sd;
  const Change* choice = nullptr;
  for (const Change& change : changes) {
    const double after = sd_of(weak, expected_covariance(set, fit, before, change));
    if (!std::isfinite(after) || after >= best) continue;
    best = after;
    choice = &change;
  }
  SharpenParameter step{weak.key, weak.effect, weak.value, sd, {}, weighed(changes), best};
  if (choice != nullptr && best <= kSharpens * sd) step.by = *choice;
  return step;
}

/// The sentence of the first of these effects that only images or single frames show.
std::string for_images(const std::vector<std::string>& ids) {
  for (const std::string& id : ids) {
    const std::string_view words = effect_of(id).next;
    if (!words.empty()) return std::string(words);
  }
  return {};
}

constexpr double kIdleShare = 0.05;  // of the gap: a named effect that takes less of it than this changes little
constexpr double kMainShare = 0.5;   // where another takes this much or more

/// The named effects that take next to nothing of a gap that others explain: a flicker that shows in the images alone.
std::set<std::string> idle_effects(const Diagnosis& diagnosis) {
  std::set<std::string> idle;
  if (std::none_of(diagnosis.explained.begin(), diagnosis.explained.end(),
                   [](const ExplainedCause& cause) { return cause.share >= kMainShare; })) {
    return idle;
  }
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    if (std::none_of(diagnosis.explained.begin(), diagnosis.explained.end(),
                     [&](const ExplainedCause& cause) { return cause.id == effect.id && cause.share >= kIdleShare; })) {
      idle.insert(effect.id);
    }
  }
  return idle;
}

}  // namespace

NextStep next_experiment(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis) {
  if (only_statements_fail(diagnosis)) {  // no further clip of the kind tells more
    return diagnosis.limits.driving.empty() ? Routine::measure_inclination : Routine::check_statements;
  }
  if (diagnosis.verdict == Verdict::unknown) return next_for_unnamed(set, comparison.fits.front(), diagnosis);
  const Hypothesis* first = leading(set, comparison, diagnosis);
  if (first == nullptr) return Routine::repeat_each_kind;
  std::vector<Contest> contests;
  const std::set<std::string> idle = idle_effects(diagnosis);
  for (const Rival& rival : rivals_of(comparison, diagnosis, *first)) {
    const bool only_idle = rival.adds.empty() && std::all_of(rival.lacks.begin(), rival.lacks.end(),
                                                             [&](const std::string& id) { return idle.contains(id); });
    if (only_idle) continue;
    const Contest contest(*first, rival);
    std::string images = for_images(contest.doubt.one.effects);
    if (images.empty()) images = for_images(contest.doubt.other.effects);
    if (!images.empty() && contests.empty()) {
      return RecordForEffect{std::move(images), contest.doubt};
    }
    const bool fitted = fit_of(comparison, *contest.right) != nullptr && fit_of(comparison, *contest.other) != nullptr;
    if (images.empty() && fitted) contests.push_back(contest);
  }
  std::vector<Alternative> undecided;
  if (!contests.empty()) {
    SettleDoubt step = settle(set, comparison, contests);
    if (step.by || !only_add(*first, contests)) return step;
    undecided = std::move(step.doubt);
  }
  std::vector<std::string> named;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    if (!idle.contains(effect.id)) named.push_back(effect.id);
  }
  if (std::string images = for_images(named); !images.empty()) return RecordForEffect{std::move(images), {}};
  if (diagnosis.verdict == Verdict::effect && diagnosis.unknown >= kStillLikely && !diagnosis.regions.empty()) {
    return next_for_unnamed(set, comparison.fits.front(), diagnosis);
  }
  const MotionFit* fit = fit_of(comparison, *first);
  std::optional<SharpenParameter> step = sharpen(set, comparison, fit != nullptr ? *fit : comparison.fits.front());
  if (!step) return Routine::repeat_each_kind;
  // What falls presses on no track, so its friction is no question.
  step->one_mass = diagnosis.verdict == Verdict::none && set.masses.size() == 1 && !only_falls(set);
  step->undecided = std::move(undecided);
  return *std::move(step);
}

namespace {

constexpr double kSameValue_sd = 0.5;  // masses, and so K/m times m, are themselves fitted

/// The size of a named effect as the verdict gives it, or K or mu as recovered; none if neither table has it.
std::optional<GapValue> in_tables(const SharpenParameter& step, const Diagnosis& diagnosis) {
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    for (const DiagnosedParameter& parameter : effect.parameters) {
      if (effect.id == step.effect && parameter.key == step.key) return GapValue{parameter.value, parameter.sd};
    }
  }
  if (!step.effect.empty()) return {};
  std::optional<GapValue> common;
  for (const RecoveredConfiguration& of : diagnosis.recovered) {
    const bool is_k = step.key == "K";
    const core::Quantity& quantity = is_k ? of.k_over_m_1_s : of.mu;
    if (!quantity.estimate) continue;
    const double unit = is_k ? of.mass_kg : 1.0;
    const GapValue one{unit * quantity.estimate->value, unit * quantity.estimate->sd};
    if (!common) common = one;
    if (!(std::abs(one.value - common->value) < kSameValue_sd * one.sd)) return {};  // each has its own
  }
  return common;
}

}  // namespace

void quote_tables(Diagnosis& diagnosis) {
  auto* const step = std::get_if<SharpenParameter>(&diagnosis.next);
  if (step == nullptr || !(step->sd > 0.0)) return;
  const std::optional<GapValue> told = in_tables(*step, diagnosis);
  if (!told || !std::isfinite(told->value) || !(told->sd > 0.0)) return;
  step->sd_after *= told->sd / step->sd;
  step->value = told->value;
  step->sd = told->sd;
}

}  // namespace glidelab::diagnose
