#include "diagnose/next/next_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/text/size_text.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/next/expected_evidence.h"
#include "diagnose/next/next_changes.h"
#include "diagnose/next/next_words.h"
#include "diagnose/result/verdict_words.h"
#include "diagnose/verdict/verdict.h"

namespace glidelab::diagnose {
namespace {

constexpr double kDecides = 5.0;        // expected log likelihood at which a change is worth making
constexpr double kMostStated = 1000.0;  // its figure means no more than that
constexpr double kStillLikely = 0.05;   // probability of a rival
constexpr std::size_t kMostRivals = 3;
constexpr double kSharpens = 0.95;  // of the standard deviation: more is not worth a clip

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

std::string joined(const std::vector<std::string>& ids) {
  std::string text;
  for (const std::string& id : ids) text += (text.empty() ? "" : " + ") + id;
  return text;
}

/// Whether the diagnosis says that these data cannot tell `other` from the leading explanation.
bool equivalent(const Diagnosis& diagnosis, const Hypothesis& first, const Hypothesis& other) {
  const std::vector<std::string> of_first = only_in(first, other), of_other = only_in(other, first);
  if (of_first.size() != 1 || of_other.size() != 1) return false;
  return std::any_of(diagnosis.effects.begin(), diagnosis.effects.end(), [&](const DiagnosedEffect& effect) {
    return effect.id == of_first.front() && holds(effect.equivalent_to, of_other.front());
  });
}

const Hypothesis* leading(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis) {
  if (diagnosis.verdict == "effect") return best_named(set, comparison);
  for (const Hypothesis& hypothesis : comparison.all) {
    if (!hypothesis.unnamed && hypothesis.effects.empty()) return &hypothesis;
  }
  return nullptr;
}

/// Most likely first: those with a twentieth of the probability, and those that these data cannot tell from the first.
std::vector<const Hypothesis*> rivals_of(const Comparison& comparison, const Diagnosis& diagnosis,
                                         const Hypothesis& first) {
  std::vector<const Hypothesis*> rivals;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.unnamed || rivals.size() == kMostRivals) continue;
    if (only_in(first, hypothesis).empty() && only_in(hypothesis, first).empty()) continue;
    const bool likely = hypothesis.probability >= kStillLikely || equivalent(diagnosis, first, hypothesis);
    if (likely) rivals.push_back(&hypothesis);
  }
  return rivals;
}

const MotionFit* fit_of(const Comparison& comparison, const Hypothesis& of) {
  return of.fit < 0 ? nullptr : &comparison.fits[static_cast<std::size_t>(of.fit)];
}

std::string likelihood_words(double gain) {
  if (gain > kMostStated) return fmt::format("more than {:.0f}", kMostStated);
  return gain < 10.0 ? fmt::format("{:.1f}", gain) : fmt::format("{:.0f}", gain);
}

/// Two explanations, of which one is taken for right: the one that has what the other lacks, because nothing shows of
/// an effect that is not there.
struct Contest {
  const Hypothesis *right, *other;
  double probability = 0.0;  // of the rival

  Contest(const Hypothesis& first, const Hypothesis& rival)
      : right(&first), other(&rival), probability(rival.probability) {
    if (only_in(first, rival).empty()) std::swap(right, other);
  }
};

/// "whether it is scale_error or direction_asymmetry or frame_rate_error, and whether there is stribeck".
std::string doubt_words(const std::vector<Contest>& contests) {
  std::string between, there;
  for (std::size_t c = 0; c < contests.size(); ++c) {
    const std::string is = joined(only_in(*contests[c].right, *contests[c].other));
    const std::string or_is = joined(only_in(*contests[c].other, *contests[c].right));
    if (or_is.empty()) {
      there += (there.empty() ? "" : " or ") + is;
      continue;
    }
    if (between.find(is) == std::string::npos) between += (between.empty() ? "" : " or ") + is;
    between += " or " + or_is;
  }
  std::string words = between.empty() ? "" : "whether it is " + between;
  if (!there.empty()) words += (words.empty() ? "" : ", and ") + ("whether there is " + there);
  return words;
}

struct Choice {
  const Change* change = nullptr;
  double gain = 0.0;
};

/// The change after which the odds of all rivals together fall most: by exp(gain).
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

/// What splits the leading explanation from its rivals, or else from the likeliest of them.
std::string split(const TrackSet& set, const Comparison& comparison, std::vector<Contest> contests) {
  const std::vector<Change> changes = feasible_changes(set, comparison.fits.front());
  Choice best = choose(set, comparison, contests, changes);
  if (contests.size() > 1 && best.gain < kDecides) {
    contests.erase(contests.begin() + 1, contests.end());
    best = choose(set, comparison, contests, changes);
  }
  const std::string doubt = doubt_words(contests);
  if (best.change == nullptr || best.gain < kDecides) {
    return fmt::format(
        "None of {} changes weighed ({}) would settle {} (expected log likelihood {:.2g} at most): a "
        "lower noise (a longer lens, a larger marker) or many more clips would.",
        changes.size(), kinds_in_words(changes), doubt, best.gain);
  }
  return fmt::format("{}: of {} changes weighed ({}) this one would settle best {} (expected log likelihood {}).",
                     best.change->words, changes.size(), kinds_in_words(changes), doubt, likelihood_words(best.gain));
}

/// A parameter for a person: its name, unit, place among the common ones, size, and what of the fit's it is.
struct Weak {
  std::string name, unit;
  Eigen::Index at = 0;
  double value = 0.0, by_member = 1.0;
};

/// Those that the explanation names; of the usual model, K and mu.
std::vector<Weak> named_parameters(const MotionFit& fit) {
  std::vector<Weak> named;
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    const auto at = static_cast<Eigen::Index>(g);
    if (globals[g].parameter == nullptr || globals[g].parameter->key.empty()) continue;
    const ShownValue value = shown(*globals[g].parameter, fit.at.global[at]);
    if (!std::isfinite(value.value)) continue;  // a v_c that fits best where it is absent
    const base::NamedUnit of = base::name_and_unit(globals[g].parameter->key);
    named.push_back({fmt::format("{} of {}", of.name, effect_list()[globals[g].effect].id), of.unit, at, value.value,
                     value.by_fitted});
  }
  if (named.empty()) named = {{"K", "N s/m", 0, fit.at.global[0], 1.0}, {"mu", "", 1, fit.at.global[1], 1.0}};
  return named;
}

/// What would be known better of an explanation that has no rival.
std::string sharpen(const TrackSet& set, const Comparison& comparison, const MotionFit& fit) {
  const Eigen::MatrixXd before = common_covariance(fit);
  const auto sd_of = [](const Weak& weak, const Eigen::MatrixXd& covariance) {
    return std::sqrt(std::max(0.0, covariance(weak.at, weak.at))) * std::abs(weak.by_member);
  };
  const std::vector<Weak> named = named_parameters(fit);
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
  const std::string known = fmt::format("Nothing else is likely; known least is {} ({}).", weak.name,
                                        base::size_and_sd_text(weak.value, sd, weak.unit));
  if (choice == nullptr || best > kSharpens * sd) {
    return fmt::format(
        "{} None of {} changes weighed ({}) would sharpen it by a twentieth: more clips of each kind "
        "would, by the root of their number.",
        known, changes.size(), kinds_in_words(changes));
  }
  return fmt::format("{} {}: of {} changes weighed ({}) this one sharpens it most, to ± {}.", known, choice->words,
                     changes.size(), kinds_in_words(changes), base::size_text(best, 2, weak.unit));
}

/// The first of these effects that only pictures or single frames show: its sentence.
std::string for_pictures(const std::vector<std::string>& ids) {
  for (const std::string& id : ids) {
    const std::string_view words = effect_of(id).next;
    if (!words.empty()) return std::string(words);
  }
  return {};
}

/// Where only what is stated contradicts the motion, no further clip of the kind tells more.
std::string for_statements(const Diagnosis& diagnosis) {
  return diagnosis.limits.driving.empty()
             ? "Measure the inclination again, with a level on the track or a plumb line in the picture: the motion "
               "and "
               "what is stated cannot both be right."
             : "Look up which way is downhill, the inclinations and the masses as they are stated, then launch one "
               "glider both ways: friction slows it whichever way it goes, an inclination does not.";
}

}  // namespace

std::string next_experiment(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis) {
  if (only_statements_fail(diagnosis)) return for_statements(diagnosis);
  if (diagnosis.verdict == "unknown") return next_for_unnamed(set, comparison.fits.front(), diagnosis);
  const Hypothesis* first = leading(set, comparison, diagnosis);
  if (first == nullptr) return "Repeat one launch of each kind: the more clips, the surer.";
  std::vector<Contest> contests;
  for (const Hypothesis* rival : rivals_of(comparison, diagnosis, *first)) {
    const Contest contest(*first, *rival);
    std::string pictures = for_pictures(only_in(*contest.right, *contest.other));
    if (pictures.empty()) pictures = for_pictures(only_in(*contest.other, *contest.right));
    if (!pictures.empty() && contests.empty())
      return fmt::format("In doubt is {}. {}", doubt_words({contest}), pictures);
    const bool fitted = fit_of(comparison, *contest.right) != nullptr && fit_of(comparison, *contest.other) != nullptr;
    if (pictures.empty() && fitted) contests.push_back(contest);
  }
  if (!contests.empty()) return split(set, comparison, std::move(contests));
  std::vector<std::string> named;
  for (const DiagnosedEffect& effect : diagnosis.effects) named.push_back(effect.id);
  const std::string pictures = for_pictures(named);
  if (!pictures.empty()) return pictures;
  if (diagnosis.verdict == "effect" && diagnosis.unknown >= kStillLikely && !diagnosis.regions.empty()) {
    return next_for_unnamed(set, comparison.fits.front(), diagnosis);
  }
  const MotionFit* fit = fit_of(comparison, *first);
  std::string words = sharpen(set, comparison, fit != nullptr ? *fit : comparison.fits.front());
  if (diagnosis.verdict == "none" && set.masses.size() == 1) {
    words += " With one mass a friction that does not grow with the load counts as mu: a second mass tells.";
  }
  return words;
}

}  // namespace glidelab::diagnose
