#include "diagnose/verdict/fit_given_causes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/errors.h"
#include "base/text/nearest_word.h"
#include "diagnose/causes/remainder.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/gap_sizes.h"
#include "diagnose/pictures/image_evidence.h"
#include "diagnose/recovered/recovered.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/single_frames/missing_frames.h"
#include "diagnose/verdict/settled_motions.h"
#include "diagnose/verdict/verdict_details.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kAllOrders = 3;  // up to so many causes all orders are tried, six at most

bool changes_the_motion(const EffectInfo& effect) {
  return shows_in_motion(effect.search) && effect.search != Search::lines;
}

std::set<std::size_t> all_but(const std::vector<std::size_t>& effects) {
  std::set<std::size_t> others;
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    if (std::find(effects.begin(), effects.end(), e) == effects.end()) others.insert(e);
  }
  return others;
}

bool shows(const EffectScan& scan) {
  return scan.visible && !scan.values.empty();
}

/// Throws an InputError with the cause, and with the effects that could be named in its place beside those of the fit.
[[noreturn]] void refuse(const MotionFit& beside, const TrackSet& set, std::size_t effect, const std::string& option) {
  std::vector<std::size_t> candidates;
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    const bool taken = std::find(beside.effects.begin(), beside.effects.end(), e) != beside.effects.end();
    if (!taken && changes_the_motion(effect_list()[e])) candidates.push_back(e);
  }
  std::vector<std::string> possible, with;
  for (const EffectScan& scan : scan_effects(ScoreSpace(set, beside), all_but(candidates), 1)) {
    if (shows(scan)) possible.emplace_back(effect_list()[scan.effect].id);
  }
  for (const std::size_t e : beside.effects) with.emplace_back(effect_list()[e].id);
  throw base::InputError(base::Issue{"", 0, option,
                                     fmt::format("\"{}\", which these recordings{} cannot show at any size{}",
                                                 effect_list()[effect].id, set.images ? "" : ", tracks without images,",
                                                 with.empty() ? "" : fmt::format(" beside {}", fmt::join(with, ", "))),
                                     possible.empty()
                                         ? "another recording: this one can show no effect at all"
                                         : fmt::format("one that they can show: {}", fmt::join(possible, ", "))});
}

/// The nominal fit with the effects added one after another.
MotionFit fit_in_order(const TrackSet& set, const MotionFit& nominal, const std::vector<std::size_t>& order,
                       const std::string& option) {
  MotionFit fit = nominal;
  for (const std::size_t effect : order) {
    const std::vector<EffectScan> scans = scan_effects(ScoreSpace(set, fit), all_but({effect}), 1);
    const EffectScan& scan = scans[effect];
    if (!shows(scan)) refuse(fit, set, effect, option);
    fit = fit_with_effect(set, fit, effect, with_effect(set, fit, effect, scan.values, scan.own));
  }
  return fit;
}

std::vector<std::vector<std::size_t>> orders_of(std::vector<std::size_t> effects) {
  if (effects.size() > kAllOrders) {
    const std::vector<std::size_t> back(effects.rbegin(), effects.rend());
    return {std::move(effects), back};
  }
  std::sort(effects.begin(), effects.end());
  std::vector<std::vector<std::size_t>> orders;
  do orders.push_back(effects);
  while (std::next_permutation(effects.begin(), effects.end()));
  return orders;
}

MotionFit best_fit(const TrackSet& set, const MotionFit& nominal, const std::vector<std::size_t>& effects,
                   const std::string& option, const base::Progress& progress) {
  const std::vector<std::vector<std::size_t>> orders = orders_of(effects);
  std::optional<MotionFit> best;
  for (std::size_t o = 0; o < orders.size(); ++o) {
    progress("fitting with the causes", static_cast<double>(o) / static_cast<double>(orders.size()));
    MotionFit fit = fit_in_order(set, nominal, orders[o], option);
    if (!best || fit.cost < best->cost) best = std::move(fit);
  }
  return std::move(*best);
}

/// The nominal fit, corrected for missing frames beyond those that the analysis corrected.
MotionFit nominal_of(const TrackSet& set) {
  const MotionFit nominal = fit_nominal(set);
  MissingFrames missing = find_missing_frames(set, nominal);
  return missing.count > 0 ? std::move(missing.fit) : nominal;
}

/// A set with its nominal fit and the fit with the causes.
struct WithCauses {
  TrackSet set;
  MotionFit nominal, fit;
};

WithCauses fits_of(TrackSet set, const ImageEvidence& images, const std::vector<std::size_t>& effects,
                   const std::string& option, const base::Progress& progress) {
  settle_noise(images, set);
  MotionFit nominal = nominal_of(set);
  MotionFit fit = best_fit(set, nominal, effects, option, progress);
  if (settle_noise_again(fit, set)) {
    nominal = nominal_of(set);
    fit = best_fit(set, nominal, effects, option, progress);
  }
  return {std::move(set), std::move(nominal), std::move(fit)};
}

/// The sizes of each cause in a fit that counts the remainder as noise.
std::vector<GivenCause> sizes_of(const WithCauses& of, const RemainderSizes& remainder, const ImageEvidence& images,
                                 const std::vector<std::string>& ids) {
  TrackSet with = of.set;
  add_remainder(of.fit, remainder, with);
  const MotionFit fit = fit_motions(with, of.fit.effects, of.fit.at, of.fit.late);
  const MotionFit& told = std::isfinite(fit.cost) ? fit : of.fit;
  std::vector<GivenCause> causes;
  for (const std::string& id : ids) {
    GivenCause cause{id, fitted_parameters(with, told, effect_index(id), images.stated_line_s)};
    const std::vector<DiagnosedParameter> derived =
        derived_parameters(with, told, effect_index(id), images, cause.parameters);
    cause.parameters.insert(cause.parameters.end(), derived.begin(), derived.end());
    causes.push_back(std::move(cause));
  }
  return causes;
}

}  // namespace

std::vector<std::string> causes_of_motion() {
  std::vector<std::string> ids;
  for (const EffectInfo& effect : effect_list()) {
    if (changes_the_motion(effect)) ids.emplace_back(effect.id);
  }
  return ids;
}

void check_given_causes(const std::vector<std::string>& ids, const std::string& option) {
  const std::vector<std::string> known = causes_of_motion(), all = effect_words();
  std::vector<base::Issue> issues;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (std::find(known.begin(), known.end(), ids[i]) == known.end()) {
      const bool is_effect = std::find(all.begin(), all.end(), ids[i]) != all.end();
      issues.push_back({"", 0, option,
                        fmt::format("\"{}\"{}", ids[i], is_effect ? ", which no fit of a motion can hold" : ""),
                        fmt::format("one of {}{}", fmt::join(known, ", "),
                                    is_effect ? std::string() : base::did_you_mean(ids[i], known))});
    } else if (std::find(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(i), ids[i]) !=
               ids.begin() + static_cast<std::ptrdiff_t>(i)) {
      issues.push_back({"", 0, option, fmt::format("\"{}\" twice", ids[i]), "each effect once"});
    }
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
}

GivenCauses fit_given_causes(core::AnalysisResults results, const std::vector<core::ClipSetup>& setups,
                             const std::vector<std::optional<core::CameraSettings>>& cameras,
                             const std::vector<std::string>& ids, const std::string& option,
                             const base::Progress& progress) {
  check_given_causes(ids, option);
  std::vector<std::size_t> effects;
  for (const std::string& id : ids) effects.push_back(effect_index(id));
  for (core::ClipResult& clip : results.clips) clip.lost_frames.clear();  // the times are corrected already
  progress("fitting with the causes", 0.0);
  TrackSet whole = whole_motions(results, setups);
  const ImageEvidence images = image_evidence(filmed_clips(results, setups, cameras));
  WithCauses of = fits_of(std::move(whole), images, effects, option, progress);
  if (of.set.disputed > 0 && is_misfit(of.set, of.fit)) {
    // The causes do not explain the hand and the stops, so these are what the analysis took them for.
    std::optional<TrackSet> trimmed = motions_without_hand(results, setups, of.set.disputed);
    if (trimmed && !explains_disputed(of.set, of.nominal, of.fit, *trimmed)) {
      of = fits_of(std::move(*trimmed), images, effects, option, progress);
    }
  }
  progress("measuring the gap", 0.9);
  const RemainderSizes remainder = RemainderSpace(of.set, of.fit).likeliest().sizes;
  GivenCauses given;
  given.causes = sizes_of(of, remainder, images, ids);
  given.recovered = recovered_of(of.set, {{&of.fit, remainder, 1.0}});
  for (RecoveredConfiguration& configuration : given.recovered) configuration.with = ids;
  std::vector<Note> notes = of.set.notes;
  const GapSizes gap = gap_of(of.set, of.nominal, of.fit, false, notes);
  given.gap_before = gap.before;
  given.gap_after = gap.after;
  given.standard_error = gap.standard_error;
  given.converged = of.fit.converged;
  given.notes = std::move(notes);
  return given;
}

}  // namespace glidelab::diagnose
