#include "diagnose/verdict/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "diagnose/effects/effect_library.h"
#include "diagnose/gap/gap_sizes.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/single_frames/missing_frames.h"
#include "diagnose/twin/twin.h"
#include "diagnose/unnamed/unnamed.h"
#include "diagnose/verdict/verdict_details.h"

namespace glidelab::diagnose {
namespace {

constexpr double kSameGain = 3.0;      // log likelihood within which effects are alike: a factor of 20 is no difference
constexpr double kSameEvidence = 4.6;  // the same of log evidence (ln 100): a law that can follow anything is no equal
constexpr double kNoChance = 5e-4;     // probability below which explanations are ranked by evidence

Explanation explanation_of(const Hypothesis& hypothesis) {
  Explanation explanation;
  explanation.unnamed = hypothesis.unnamed;
  for (const std::size_t e : hypothesis.effects) explanation.effects.emplace_back(effect_list()[e].id);
  return explanation;
}

bool same_but(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b, std::size_t from, std::size_t to) {
  std::vector<std::size_t> expected = a, other = b;
  if (std::find(a.begin(), a.end(), from) == a.end()) return false;
  std::replace(expected.begin(), expected.end(), from, to);
  std::sort(expected.begin(), expected.end());
  std::sort(other.begin(), other.end());
  return expected == other;
}

/// Beside a remainder, effects look alike that would not take the same part of the gap.
bool leaves_as_little(const Hypothesis& other, const Hypothesis& best) {
  return other.left.value_or(0.0) < best.left.value_or(0.0) + kSameLeft;
}

std::vector<DiagnosedParameter> parameters_of(const TrackSet& set, const Comparison& comparison,
                                              const ImageEvidence& images, const MotionFit* fitted,
                                              std::size_t effect) {
  std::vector<DiagnosedParameter> parameters;
  for (const ImageFinding& finding : images.findings) {
    if (finding.id == effect_list()[effect].id && (finding.seen || effect_list()[effect].search == Search::images)) {
      parameters = finding.parameters;
    }
  }
  for (const FrameEffect& frame : comparison.frames) {
    if (frame.effect != effect) continue;
    if (!parameters.empty()) continue;
    parameters.push_back({std::string(effect_list()[effect].point_scatter.key), frame.value, frame.sd});
  }
  if (fitted == nullptr) return parameters;
  const MotionFit& fit = *fitted;
  if (parameters.empty() && effect == effect_index(ids::dropped_frames)) {
    const auto points = static_cast<double>(points_of(set));
    const auto count = static_cast<double>(missing_in(set, fit));
    if (count > 0.0) parameters.push_back({"fraction", count / points, std::sqrt(count) / points});
  }
  for (const DiagnosedParameter& tracked : fitted_parameters(set, fit, effect, images.stated_line_s)) {
    const auto known =
        std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.key == tracked.key; });
    if (known == parameters.end()) {
      parameters.push_back(tracked);
    } else if (tracked.sd < known->sd) {  // the images show it too, but less precisely
      *known = tracked;
    }
  }
  const std::vector<DiagnosedParameter> derived = derived_parameters(set, fit, effect, images, parameters);
  parameters.insert(parameters.end(), derived.begin(), derived.end());
  return parameters;
}

/// The number of parameters that a hypothesis adds to the nominal model: those of its fit, and those of effects that no
/// fit contains.
std::size_t parameters_added(const TrackSet& set, const Comparison& comparison, const Hypothesis& hypothesis) {
  const ParameterLayout with(set, hypothesis.effects), nominal(set, {});
  std::size_t count = with.globals().size() - nominal.globals().size() + with.own().size() * set.motions.size();
  for (const std::size_t e : hypothesis.effects) {
    const EffectInfo& info = effect_list()[e];
    if (info.search == Search::frames) {
      ++count;
      if (hypothesis.fit >= 0) count += missing_in(set, comparison.fits[static_cast<std::size_t>(hypothesis.fit)]);
    }
    if (info.search == Search::images) ++count;
    count += info.point_scatter.parameters;
  }
  return count;
}

std::optional<Stage> stage_of(const std::vector<UnnamedFamily>& families) {
  const auto best = std::max_element(families.begin(), families.end(),
                                     [](const auto& a, const auto& b) { return a.log_evidence < b.log_evidence; });
  if (best == families.end()) return std::nullopt;
  return best->what == GapKind::displacement || best->what == GapKind::scale ? Stage::optics
         : best->what == GapKind::lateness                                   ? Stage::timing
                                                                             : Stage::dynamics;
}

Isolability isolability_of(const TrackSet& set, const MotionFit& nominal, const Comparison& comparison) {
  const ScoreSpace space(set, nominal);
  Isolability result;
  std::vector<const EffectScan*> seen;
  for (const EffectScan& scan : comparison.scans) {
    if (scan.visible && scan.direction.rest.size() > 0) seen.push_back(&scan);
  }
  for (const EffectScan* a : seen) {
    result.ids.emplace_back(effect_list()[a->effect].id);
    result.least_seen.push_back(a->least_seen);
    std::vector<double> row;
    const double aa = space.dot(a->direction, a->direction);
    for (const EffectScan* b : seen) {
      const double bb = space.dot(b->direction, b->direction);
      row.push_back(std::min(1.0, std::abs(space.dot(a->direction, b->direction)) / std::sqrt(aa * bb)));
    }
    result.cosine.push_back(std::move(row));
  }
  return result;
}

std::vector<NamedExplanation> named_explanations(const Comparison& comparison) {
  std::vector<NamedExplanation> named;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.unnamed) continue;
    named.push_back({explanation_of(hypothesis).effects, hypothesis.probability});
  }
  return named;
}

/// The measured motions, each under the name of its clip in the twin.
std::vector<MeasuredMotion> measured_of(const TrackSet& set, const Twin& twin) {
  std::vector<MeasuredMotion> measured;
  for (const TwinClip& clip : twin.clips) {
    const TrackedMotion& motion = set.motions[clip.motion];
    MeasuredMotion& one = measured.emplace_back();
    one.clip = clip.name;
    one.recorded = set.pieces ? 0 : motion.clip;
    one.start_s = motion.t_s.front();
    one.noise_m = motion.sd_m;
    one.bandwidth_s = set.clips[motion.clip].bandwidth_s;
    for (std::size_t p = 0; p < motion.t_s.size(); ++p) {
      if (motion.outlier[p]) continue;
      one.t_s.push_back(motion.t_s[p]);
      one.x_m.push_back(motion.x_m[p]);
    }
  }
  return measured;
}

/// The causes of the gap by falling share, then the effects of the explanation that no motion shows.
std::vector<std::size_t> named_effects(const Hypothesis& best, const NoiseAlone* noise_alone) {
  if (noise_alone == nullptr) return best.effects;
  std::vector<std::size_t> effects = noise_alone->best.effects;
  for (const std::size_t e : best.effects) {
    if (!shows_in_motion(effect_list()[e].search) && std::find(effects.begin(), effects.end(), e) == effects.end())
      effects.push_back(e);
  }
  if (effects.empty()) return best.effects;  // none takes a part of the gap by itself
  return effects;
}

/// Whether the two act in the same explanations more often than one of them alone: then neither stands for the other.
bool act_together(const Comparison& comparison, std::size_t one, std::size_t other) {
  double both = 0.0;
  for (const Hypothesis& of : comparison.all) {
    if (!of.unnamed && has(of, one) && has(of, other)) both += of.probability;
  }
  return both > 0.5 * std::min(probability_of_any(comparison, {one}), probability_of_any(comparison, {other}));
}

/// Beside a remainder the evidence counts for less than it says (cause_odds.h): what it makes of the probabilities is
/// what tells two explanations apart.
bool is_about_as_likely(const Hypothesis& other, const Hypothesis& best) {
  constexpr double kPartOfBest = 1.0 / 3.0;
  return best.left && other.left && other.probability > kPartOfBest * best.probability;
}

}  // namespace

std::vector<std::size_t> not_told_apart(const Comparison& comparison, const Hypothesis& best, std::size_t effect,
                                        bool filmed) {
  std::vector<std::size_t> others;
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    if (e == effect || has(best, e)) continue;
    if (!comparison.alike.empty() && are_alike(comparison, e, effect, filmed)) {
      others.push_back(e);  // whatever has become of its fit beside the other effects
      continue;
    }
    if (act_together(comparison, e, effect)) continue;
    for (const Hypothesis& other : comparison.all) {
      if (other.unnamed || !same_but(best.effects, other.effects, effect, e)) continue;
      // The scatter of single positions is no other name for an effect that shifts them all.
      const bool same_cause =
          first_alike(e, filmed) == first_alike(effect, filmed);  // evidence tells them apart only by chance
      if (is_scatter(e) != is_scatter(effect) || !leaves_as_little(other, best)) break;
      const bool same_evidence = (same_cause || other.log_evidence > best.log_evidence - kSameEvidence) &&
                                 other.gain > best.gain - kSameGain && other.gain > kSameGain;
      if (same_evidence || is_about_as_likely(other, best)) others.push_back(e);
      break;
    }
  }
  return others;
}

std::vector<RankedExplanation> ranking_of(const TrackSet& set, const Comparison& comparison,
                                          const NoiseAlone* noise_alone) {
  std::vector<RankedExplanation> ranking;
  std::map<int, double> gaps;  // once for each fit: what single frames and images show does not change it
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.unnamed || hypothesis.effects.empty()) continue;
    RankedExplanation ranked{explanation_of(hypothesis),
                             hypothesis.probability,
                             hypothesis.log_evidence,
                             hypothesis.gain,
                             parameters_added(set, comparison, hypothesis),
                             {}};
    if (hypothesis.fit >= 0 && hypothesis.converged) {
      const auto [gap, is_new] = gaps.emplace(hypothesis.fit, 0.0);
      if (is_new) {
        const MotionFit& fit = comparison.fits[static_cast<std::size_t>(hypothesis.fit)];
        gap->second = noise_alone != nullptr
                          ? held_out_gap(noise_alone->set, linearise_again(noise_alone->set, fit)).value
                          : held_out_gap(set, fit).value;
      }
      ranked.gap_after = gap->second;
    }
    ranked.converged = hypothesis.converged;
    ranking.push_back(std::move(ranked));
  }
  // Hypotheses do not come in order: what single frames and images show has changed their probabilities. Those next to
  // 0 go by evidence, which does not underflow.
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  const auto rest =
      std::find_if(ranking.begin(), ranking.end(), [](const auto& ranked) { return ranked.probability < kNoChance; });
  std::stable_sort(rest, ranking.end(),
                   [](const auto& a, const auto& b) { return a.log_evidence_gain > b.log_evidence_gain; });
  return ranking;
}

void cap_probabilities(double most, Diagnosis& diagnosis) {
  double highest = diagnosis.none;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    highest = std::max({highest, effect.probability, effect.joint_probability});
  }
  for (const RankedExplanation& ranked : diagnosis.ranking) highest = std::max(highest, ranked.probability);
  const double known = 1.0 - diagnosis.unknown;
  if (diagnosis.unknown > most && !(known > 0.0)) {
    diagnosis.unknown = most;
    diagnosis.none = 1.0 - most;
    return;
  }
  const double factor = diagnosis.unknown > most ? (1.0 - most) / known : highest > most ? most / highest : 1.0;
  if (factor == 1.0) return;
  diagnosis.unknown = 1.0 - factor * known;
  diagnosis.none *= factor;
  for (DiagnosedEffect& effect : diagnosis.effects) {
    effect.probability *= factor;
    effect.joint_probability *= factor;
    for (AlikeEffect& alike : effect.alike) {
      if (alike.probability) *alike.probability *= factor;
    }
  }
  for (RankedExplanation& ranked : diagnosis.ranking) ranked.probability *= factor;
}

Diagnosis verdict_of(const TrackSet& set, const Comparison& comparison, ImageEvidence images,
                     const NoiseAlone* noise_alone) {
  Diagnosis diagnosis;
  diagnosis.notes = set.notes;
  diagnosis.none = comparison.none;
  diagnosis.unknown = comparison.unknown;
  diagnosis.verdict = verdict_by(comparison.none, comparison.unknown);
  const Hypothesis* best = best_named(set, comparison);
  const MotionFit& nominal = comparison.fits.front();
  diagnosis.limits = limits_of(set, nominal);
  const bool driven = diagnosis.verdict == Verdict::none && !diagnosis.limits.driving.empty();
  constexpr double kAboveNoise = 1.2;  // times the noise: less of a gap is one by chance
  const bool aside = diagnosis.verdict == Verdict::none && diagnosis.limits.set_aside &&
                     diagnosis.limits.set_aside->is_large() && held_out_gap(set, nominal).value > kAboveNoise;
  if (driven || aside) {  // whatever drives the glider, or acts in what is set aside, has no name
    diagnosis.unknown += std::exchange(diagnosis.none, 0.0);
    diagnosis.verdict = verdict_by(diagnosis.none, diagnosis.unknown);
  }
  const MotionFit* fit = &nominal;
  if (diagnosis.verdict == Verdict::effect && best != nullptr) {
    const MotionFit* sized = noise_alone != nullptr ? &noise_alone->sized
                             : best->fit >= 0       ? &comparison.fits[static_cast<std::size_t>(best->fit)]
                                                    : nullptr;
    if (sized != nullptr) fit = sized;
    const TrackSet& sized_set = noise_alone != nullptr ? noise_alone->sized_set : set;
    const std::vector<std::size_t> named = named_effects(*best, noise_alone);
    const Hypothesis* explanation = find(comparison, {named.begin(), named.end()});
    if (explanation == nullptr) explanation = best;
    for (const std::size_t e : named) {
      const EffectInfo& info = effect_list()[e];
      std::vector<std::size_t> others = not_told_apart(comparison, *explanation, e, set.images);
      if (has(*best, e)) {  // beside a cause that is not named, others may take its place
        for (const std::size_t other : not_told_apart(comparison, *best, e, set.images)) {
          const bool known = std::find(others.begin(), others.end(), other) != others.end() ||
                             std::find(named.begin(), named.end(), other) != named.end();
          if (!known) others.push_back(other);
        }
      }
      std::vector<std::string> alike;
      for (const std::size_t other : others) alike.emplace_back(effect_list()[other].id);
      diagnosis.effects.push_back({std::string(info.id), info.stage, std::string(info.words),
                                   comparison.effect_probability[e], std::move(alike),
                                   parameters_of(sized_set, comparison, images, sized, e)});
    }
    if (noise_alone == nullptr) {  // otherwise they are in order of their shares
      std::stable_sort(diagnosis.effects.begin(), diagnosis.effects.end(),
                       [](const auto& a, const auto& b) { return a.probability > b.probability; });
    }
    join_alike(
        named_explanations(comparison),
        [](const std::string& id) { return std::string(effect_list()[effect_index(id)].words); }, diagnosis);
    diagnosis.stage = diagnosis.effects.front().stage;
  }
  diagnosis.points = points_of(set);
  diagnosis.ranking = ranking_of(set, comparison, noise_alone);
  // Beside sizes of each clip's own little is left of any effect, and not where it lies.
  const std::vector<std::size_t>& leading = comparison.all.front().effects;
  const bool beside_named =
      diagnosis.verdict == Verdict::unknown && !std::all_of(leading.begin(), leading.end(), differs_between_clips);
  const std::vector<UnnamedFamily>& families = beside_named ? comparison.unnamed_left : comparison.unnamed;
  // K or mu is negative, or much is set aside: no function is known to be missing.
  const bool drives = (driven || aside) && diagnosis.verdict == Verdict::unknown;
  if (drives) {
    diagnosis.stage = Stage::dynamics;
  } else if (diagnosis.verdict != Verdict::none) {
    if (diagnosis.verdict == Verdict::unknown) {
      const bool runs = add_error_runs(set, comparison.frames, families, diagnosis);
      diagnosis.stage = runs ? Stage::tracking : stage_of(families);
    }
    add_regions(set, nominal, families, diagnosis);
  }
  add_image_regions(images, diagnosis);
  const MotionFit* gap_fit = fit;
  MotionFit with;
  if (diagnosis.verdict == Verdict::unknown && !drives && set.clips.size() > 1 && noise_alone == nullptr) {
    // The likeliest function without a name stands for what is missing.
    const UnnamedFamily* family = likeliest_shared(families);
    const MotionFit& beside = beside_named ? comparison.fits[static_cast<std::size_t>(comparison.beside_fit)] : nominal;
    if (family != nullptr) {
      with = with_unnamed(set, beside, *family);
      gap_fit = &with;
    }
  }
  const TrackSet& gap_set = noise_alone != nullptr ? noise_alone->set : set;
  const MotionFit& gap_nominal = noise_alone != nullptr ? noise_alone->nominal : nominal;
  if (noise_alone != nullptr) gap_fit = diagnosis.verdict == Verdict::effect ? &noise_alone->best : &gap_nominal;
  diagnosis.gap = gap_of(gap_set, gap_nominal, *gap_fit, diagnosis.verdict == Verdict::unknown, diagnosis.notes);
  if (fit != &nominal) {
    std::vector<ContradictedIncline> without = std::move(diagnosis.limits.contradicted);
    diagnosis.limits = limits_of(noise_alone != nullptr ? noise_alone->sized_set : set, *fit);
    if (diagnosis.limits.contradicted.empty()) diagnosis.limits.resolved = std::move(without);
  }
  for (const NegativeLoss& one : diagnosis.limits.driving) diagnosis.notes.emplace_back(one);
  for (const ContradictedIncline& one : diagnosis.limits.contradicted) diagnosis.notes.emplace_back(one);
  if (diagnosis.limits.set_aside) diagnosis.notes.emplace_back(*diagnosis.limits.set_aside);
  diagnosis.residuals = residuals_of(gap_set, gap_nominal, *gap_fit);
  diagnosis.isolability = isolability_of(set, nominal, comparison);
  Twin twin = twin_of(set, *fit, diagnosis.effects, diagnosis.verdict == Verdict::unknown, images.filming);
  diagnosis.measured = measured_of(set, twin);
  diagnosis.twin = std::move(twin.toml);
  diagnosis.twin_lacks = std::move(twin.lacks);
  diagnosis.twin_from_m = twin.from_m;
  diagnosis.images = std::move(images.findings);
  diagnosis.image_curves = std::move(images.curves);
  diagnosis.gap->domains = gap_domains(*diagnosis.gap, diagnosis.images, diagnosis.effects);
  return diagnosis;
}

}  // namespace glidelab::diagnose
