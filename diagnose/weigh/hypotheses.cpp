#include "diagnose/weigh/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/integrated_start.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/unnamed/unnamed.h"
#include "diagnose/weigh/fit_odds.h"
#include "diagnose/weigh/hypothesis_pairs.h"
#include "diagnose/weigh/joined_evidence.h"
#include "diagnose/weigh/twin_fits.h"
#include "diagnose/weigh/unknown_noise.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPriorNone = 0.3, kPriorOne = 0.4, kPriorTwo = 0.1, kPriorUnnamed = 0.2;
constexpr std::size_t kMostFitted = 9;        // effects of the short list that are fitted in full
constexpr double kLeastEvidenceBeside = 3.0;  // log evidence above which something else is weighed beside an effect
constexpr double kNoLossSeen = -3.0;          // log evidence of lost frames if none is found
constexpr double kWeakEvidence = 6.0;         // log evidence below which something unnamed shows only weakly
constexpr double kWeakShare = 0.01;  // of the effects' log evidence: below this, something unnamed leaves the effects
                                     // their name

void add_unnamed(const TrackSet& set, const Work& work, Comparison& comparison) {
  std::vector<Hypothesis> around = leaders_of(comparison, 1, 2);
  for (const Hypothesis& pair : leaders_of(comparison, 2, 2)) around.push_back(pair);
  std::sort(around.begin(), around.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  bool first = true;
  double likeliest = 0.0;
  for (const Hypothesis& named : around) {
    if (named.log_evidence < kLeastEvidenceBeside) continue;
    work.look();
    const ScoreSpace space(set, comparison.fits[static_cast<std::size_t>(named.fit)]);
    std::vector<UnnamedFamily> families = unnamed_families(space, work.jobs);
    Hypothesis both = named;
    both.unnamed = true;
    both.unnamed_log_evidence = log_unnamed_evidence(families);
    both.log_evidence += both.unnamed_log_evidence;
    for (const UnnamedFamily& family : families) both.gain = std::max(both.gain, named.gain + family.gain);
    comparison.all.push_back(both);
    if (comparison.unnamed_left.empty() || both.log_evidence > likeliest) {
      likeliest = both.log_evidence;
      comparison.unnamed_left = std::move(families);
      comparison.beside_fit = named.fit;
    }
    if (first) comparison.left_fit = named.fit;
    first = false;
  }
}

/// Single-frame effects join the hypotheses, alone and with the best of the others.
void add_frame_effects(Comparison& comparison) {
  const std::vector<Hypothesis> so_far = comparison.all;
  for (const FrameEffect& frame : comparison.frames) {
    for (const Hypothesis& other : so_far) {
      if (other.effects.size() > 1 || (other.effects.size() == 1 && other.log_evidence < kLeastEvidenceBeside))
        continue;
      if (std::find(other.effects.begin(), other.effects.end(), frame.effect) != other.effects.end()) continue;
      Hypothesis with = other;
      with.effects.push_back(frame.effect);
      with.gain += frame.gain;
      with.log_evidence += frame.log_evidence;
      comparison.all.push_back(with);
      if (with.unnamed || frame.in_runs <= 0.0) continue;
      // Errors that last over several frames, or come at a clip's start, are in no list.
      with.effects = other.effects;
      with.unnamed = true;
      with.unnamed_log_evidence = frame.log_evidence + frame.in_runs;
      with.log_evidence += frame.in_runs;
      comparison.all.push_back(with);
    }
  }
}

/// In filmed experiments, effects keep their name beside something unnamed that shows weakly, with a hundredth of their
/// log evidence: a lens, a sensor and a tracker leave some micrometres that no list contains, and these show the
/// better, the better an effect shows. The probability then goes to the effects. (A remainder that shows clearly is
/// another matter: an effect absorbs most of many a thing that is not in the list.)
void give_trifles_to_their_effects(Comparison& comparison) {
  for (Hypothesis& with : comparison.all) {
    if (!with.unnamed || with.effects.empty()) continue;
    const double of_effects = with.log_evidence - with.unnamed_log_evidence;
    if (with.unnamed_log_evidence >= std::min(kWeakEvidence, kWeakShare * of_effects)) continue;
    const auto named = std::find_if(comparison.all.begin(), comparison.all.end(), [&](const Hypothesis& other) {
      return !other.unnamed && other.effects == with.effects;
    });
    if (named == comparison.all.end()) continue;
    named->probability += std::exchange(with.probability, 0.0);
  }
}

void allow_for_unknown_noise(const TrackSet& set, Comparison& comparison) {
  const std::optional<FewPositions> few = few_positions(set);
  const double chi2 = comparison.fits.front().cost;
  for (Hypothesis& one : comparison.all) one.log_evidence -= lost_to_unknown_noise(few, chi2, one.gain);
}

/// Whether the scatter of single positions could show this effect; true for any other effect.
bool scatter_shows(const Comparison& comparison, std::size_t effect) {
  return !is_scatter(effect) || std::any_of(comparison.frames.begin(), comparison.frames.end(),
                                            [&](const FrameEffect& frame) { return frame.effect == effect; });
}

}  // namespace

void weigh(const TrackSet& set, const std::set<std::size_t>& without, Comparison& comparison) {
  const auto& list = effect_list();
  set_fit_odds(set, comparison);
  double seen = 0.0;
  for (std::size_t e = 0; e < list.size(); ++e) {
    const bool tracked = list[e].search != Search::images && scatter_shows(comparison, e) &&
                         (!shows_in_motion(list[e].search) || comparison.scans[e].visible);
    const bool shown = tracked || comparison.in_images.contains(e);
    const bool candidate = !without.contains(e) && shown;
    seen += candidate ? 1.0 : 0.0;
  }
  const double one = std::log(kPriorOne / std::max(1.0, seen));
  const double two = std::log(kPriorTwo / std::max(1.0, 0.5 * seen * (seen - 1.0)));
  std::vector<double> logs;
  for (const Hypothesis& hypothesis : comparison.all) {
    const bool one_air = set.through_air && is_drag_with_its_air(hypothesis.effects);
    const std::size_t many = hypothesis.effects.size() - (one_air ? 1 : 0);
    double prior = many == 0   ? std::log(kPriorNone)
                   : many == 1 ? one
                               : two + static_cast<double>(many - 2) * (two - one);
    if (hypothesis.unnamed) prior += std::log(kPriorUnnamed / (1.0 - kPriorUnnamed));
    logs.push_back(prior + log_prior_odds(comparison, hypothesis) + hypothesis.log_evidence);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double& l : logs) sum += l = std::exp(l - most);
  for (std::size_t h = 0; h < logs.size(); ++h) comparison.all[h].probability = logs[h] / sum;
  if (set.images) give_trifles_to_their_effects(comparison);
  set_probabilities(comparison);
}

Comparison compare_hypotheses(const TrackSet& set, const std::vector<std::size_t>& without, int jobs,
                              const ImageEvidence* images, const std::function<void(double)>& done) {
  const Work work{jobs, done};
  const std::set<std::size_t> left_out(without.begin(), without.end());
  Comparison comparison;
  comparison.fits.push_back(fit_nominal(set));
  comparison.all.push_back({{}, false, 0.0, 0.0, 0.0, 0});
  const MotionFit nominal = comparison.fits.front();
  const ScoreSpace space(set, nominal);
  work.look();
  comparison.scans = scan_effects(space, left_out, jobs);
  comparison.alike = alike_in(space, comparison.scans);
  for (std::size_t e = 0; e < effect_list().size(); ++e) comparison.odds.push_back(prior_odds(set, e));
  work.at(0.1).look();
  comparison.unnamed = unnamed_families(space, jobs);
  Hypothesis unnamed;
  unnamed.unnamed = true;
  unnamed.unnamed_log_evidence = log_unnamed_evidence(comparison.unnamed);
  unnamed.log_evidence = unnamed.unnamed_log_evidence;
  for (const UnnamedFamily& family : comparison.unnamed) unnamed.gain = std::max(unnamed.gain, family.gain);
  comparison.all.push_back(unnamed);

  const Hypothesis nothing = comparison.all.front();
  fit_best(set, nominal, best_of(comparison.scans, kMostFitted), nothing, work.at(0.2), comparison);
  // In a fall through air the drag in place of K is fitted even if it does not show beside K. So is a scale or a clock
  // that is off: K imitates either.
  const std::size_t air = effect_index(ids::quadratic_drag);
  for (const std::size_t effect : {air, effect_index(ids::scale_error), effect_index(ids::frame_rate_error)}) {
    if (!set.through_air || left_out.contains(effect) || find(comparison, {effect}) != nullptr) continue;
    EffectScan scan = comparison.scans[effect];
    if (!scan.visible && effect != air) continue;
    if (scan.values.empty()) scan.values = {effect_list()[effect].parameters.front().step};
    add(comparison, fit_more(set, nominal, scan, nothing));
  }
  if (is_misfit(set, nominal)) {
    // The neighbourhood of a fit that follows no bounce does not show what causes it.
    for (const EffectScan& scan : comparison.scans) {
      if (!scan.visible || scan.values.empty() || !has_integrated_start(scan.effect)) continue;
      if (find(comparison, {scan.effect}) == nullptr) add(comparison, fit_more(set, nominal, scan, nothing));
    }
  }
  for (const EffectScan& scan : comparison.scans) {
    const bool fitted = std::any_of(comparison.all.begin(), comparison.all.end(), [&](const Hypothesis& h) {
      return h.effects == std::vector<std::size_t>{scan.effect};
    });
    if (scan.visible && !fitted)
      comparison.all.push_back({{scan.effect}, false, scan.gain, scan.log_evidence, 0.0, -1});
  }
  if (const auto dropped = effect_index(ids::dropped_frames); !left_out.contains(dropped)) {
    work.at(0.4).look();
    comparison.missing = find_missing_frames(set, nominal, jobs);
    if (comparison.missing.count > 0) {
      Found found;
      found.fit = comparison.missing.fit;
      found.hypothesis.effects = {dropped};
      found.hypothesis.gain = comparison.missing.effect.gain;
      found.hypothesis.log_evidence = comparison.missing.effect.log_evidence;
      add(comparison, std::move(found));
    } else {
      comparison.all.push_back({{dropped}, false, 0.0, kNoLossSeen, 0.0, -1});
    }
  }
  add_pairs(set, space, left_out, work.at(0.5), comparison);
  add_losses_beside(set, nominal, left_out, work.at(0.75), comparison);
  add_twins(set, left_out, work.at(0.78), comparison);
  add_unnamed(set, work.at(0.8), comparison);
  const MotionFit& best = comparison.fits[static_cast<std::size_t>(comparison.left_fit)];
  for (const FrameEffect& frame : {scan_jitter(set, best), scan_tails(set, best)}) {
    if (!left_out.contains(frame.effect) && frame.visible) comparison.frames.push_back(frame);
  }
  add_frame_effects(comparison);
  if (images != nullptr) join_images(set, *images, left_out, comparison);
  allow_for_unknown_noise(set, comparison);
  weigh(set, left_out, comparison);
  return comparison;
}

}  // namespace glidelab::diagnose
