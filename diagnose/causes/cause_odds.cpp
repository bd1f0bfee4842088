#include "diagnose/causes/cause_odds.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr double kTailScale = 5.0, kTailPower = 2.45;                     // s and n of cause_odds.h
constexpr double kNameOdds = 1.1, kLeftSlope = 12.5, kExcessSlope = 0.8;  // a, b and c of cause_odds.h
constexpr double kAgainstUnnamedBeside = 1.4;  // log odds against a function without a name beside causes,
constexpr double kAgainstUnnamedAlone = 1.0;   // and alone
constexpr double kImitatedPart = 0.08;         // part of a cause's probability that belongs to a cause off the list
constexpr double kAgainstFurtherCause = 2.0;   // log odds against each further cause where the noise is negligible
constexpr double kLeftPower = 0.5;  // of the part that is left, where the noise is negligible and that spans decades
constexpr double kNoClipHeldOut = -1.0;                   // the excess of a gap of 0: no clip was held out
constexpr double kLeastExcess = 0.1, kMostExcess = 10.0;  // limits of E in cause_odds.h

/// The log evidence that counts. Every remainder contains friction and drag of each clip too, so that clip scatter has
/// at least the evidence of the nominal model, and beside a cause known by stated inclinations that of this cause.
double evidence_of(const Hypothesis& one, const std::vector<Hypothesis>& all, const std::set<std::size_t>& by_stated) {
  const std::size_t scatter = effect_index(ids::clip_scatter);
  if (!has(one, scatter)) return one.log_evidence;
  std::set<std::size_t> others(one.effects.begin(), one.effects.end());
  others.erase(scatter);
  if (!std::ranges::all_of(others, [&](std::size_t e) { return by_stated.contains(e); })) return one.log_evidence;
  double most = others.empty() && !one.unnamed ? std::max(one.log_evidence, 0.0) : one.log_evidence;
  for (const Hypothesis& other : all) {
    const bool same = other.unnamed == one.unnamed && std::set(other.effects.begin(), other.effects.end()) == others;
    if (same && (other.fit > 0 || others.empty())) most = std::max(most, other.log_evidence);
  }
  return most;
}

double part_left(double left, double before) {
  if (!(before > kLeastExcess) || !(left > kNoClipHeldOut)) return 1.0;
  return std::clamp(left / before, 0.0, 1.0);
}

/// Explanations that differ only in the scatter of single positions, which makes no gap. They are one explanation of
/// the gap, and the one without scatter stands for them.
struct SameCauses {
  std::size_t plain = 0;
  std::vector<std::size_t> all;
};

std::vector<SameCauses> by_causes(const std::vector<Hypothesis>& all) {
  std::map<std::pair<bool, std::vector<std::size_t>>, SameCauses> groups;
  for (std::size_t h = 0; h < all.size(); ++h) {
    std::vector<std::size_t> causes = all[h].effects;
    std::erase_if(causes, is_scatter);
    std::sort(causes.begin(), causes.end());
    SameCauses& group = groups[{all[h].unnamed, causes}];
    const bool first = group.all.empty();
    if (first || all[h].effects.size() < all[group.plain].effects.size()) group.plain = h;
    group.all.push_back(h);
  }
  std::vector<SameCauses> list;
  for (auto& [causes, group] : groups) list.push_back(std::move(group));
  return list;
}

/// Whether it has a cause that makes a gap beside the drag of air, and a fit.
bool is_beside_drag_of_air(const Hypothesis& one) {
  if (one.unnamed || one.fit <= 0 || !has(one, effect_index(ids::quadratic_drag))) return false;
  return std::count_if(one.effects.begin(), one.effects.end(),
                       [](std::size_t e) { return takes_part_of_gap(effect_list()[e].search); }) > 1;
}

/// What the drag of air alone leaves in a fall; none elsewhere, or if that was not measured.
std::optional<double> excess_of_drag_of_air(const LeftExcess& excess, const Comparison& comparison) {
  const Hypothesis* drag = find(comparison, {effect_index(ids::quadratic_drag)});
  if (!excess.without_drag || drag == nullptr || drag->fit <= 0) return {};
  const double left = excess.of_fits[static_cast<std::size_t>(drag->fit)];
  return left > kNoClipHeldOut ? std::optional(left) : std::nullopt;
}

double tempered(double behind) {
  return -kTailPower * std::log1p(behind / kTailScale);
}

}  // namespace

bool noise_is_negligible(const std::vector<double>& excess) {
  const auto near_noise = [](double of_one) { return of_one > kNoClipHeldOut && of_one <= kNearNoise; };
  return excess.front() > kLargestExcess && std::none_of(excess.begin(), excess.end(), near_noise);
}

void weigh_beside_remainder(const LeftExcess& excess, Comparison& comparison) {
  std::vector<Hypothesis>& all = comparison.all;
  const std::vector<SameCauses> groups = by_causes(all);
  double best = -std::numeric_limits<double>::infinity();
  for (const SameCauses& group : groups) best = std::max(best, all[group.plain].log_evidence);
  const std::vector<double>& left = excess.of_fits;
  const bool no_noise = noise_is_negligible(left);
  const auto before = [&](const Hypothesis& one) {
    return has(one, effect_index(ids::quadratic_drag)) ? excess.without_drag.value_or(left.front()) : left.front();
  };
  const auto named = [](double of) {
    return kNameOdds + kExcessSlope * std::log(std::clamp(of, kLeastExcess, kMostExcess));
  };
  for (Hypothesis& one : all) {
    one.left = part_left(one.fit > 0 ? left[static_cast<std::size_t>(one.fit)] : left.front(), before(one));
  }
  const std::optional<double> of_drag = excess_of_drag_of_air(excess, comparison);
  std::vector<double> logs;
  for (const SameCauses& group : groups) {
    const Hypothesis& one = all[group.plain];
    double log = tempered(best - evidence_of(one, all, comparison.by_stated));
    if (no_noise) {
      log = -kAgainstFurtherCause * std::max(0.0, static_cast<double>(one.effects.size()) - 1.0);
      log -= kLeftPower * std::log(std::max(*one.left, 1.0 / kLargestExcess));
    }
    if (of_drag && is_beside_drag_of_air(one)) {
      log += named(before(one)) - kLeftSlope * part_left(*of_drag, before(one));
      log += named(*of_drag) - kLeftSlope * part_left(left[static_cast<std::size_t>(one.fit)], *of_drag);
    } else if (shows_in_gap(one, comparison.by_stated)) {
      log += named(before(one)) - kLeftSlope * *one.left;
    }
    if (one.unnamed && one.effects.empty()) {
      log += std::max(
          0.0, named(left.front()) - kAgainstUnnamedAlone - kLeftSlope * part_left(excess.of_unnamed, left.front()));
    }
    for (const std::size_t e : one.effects) log += effect_list()[e].log_odds_beside_remainder;
    log += log_prior_odds(comparison, one);
    if (one.unnamed) log -= kAgainstUnnamedBeside;
    logs.push_back(log);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double& log : logs) sum += log = std::exp(log - most);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::vector<std::size_t>& of = groups[g].all;
    double likeliest = -std::numeric_limits<double>::infinity(), parts = 0.0;
    for (const std::size_t h : of) likeliest = std::max(likeliest, all[h].log_evidence);
    for (const std::size_t h : of) {
      const auto further = static_cast<double>(all[h].effects.size() - all[groups[g].plain].effects.size());
      const double log = no_noise ? -kAgainstFurtherCause * further : tempered(likeliest - all[h].log_evidence);
      parts += all[h].probability = std::exp(log);
    }
    for (const std::size_t h : of) all[h].probability *= logs[g] / sum / parts;
  }
  // A function beside a cause counts towards the cause. Scatter of single positions alone counts towards no cause: it
  // makes no gap.
  for (Hypothesis& from : all) {
    const bool scatter_alone = is_scatter_alone(from);
    if (!scatter_alone && (!from.unnamed || from.effects.empty())) continue;
    for (Hypothesis& pure : all) {
      if (pure.unnamed || (scatter_alone ? !pure.effects.empty() : pure.effects != from.effects)) continue;
      pure.probability += std::exchange(from.probability, 0.0);
    }
  }
  // Some causes off the list look like one on it.
  auto unknown =
      std::find_if(all.begin(), all.end(), [](const Hypothesis& one) { return one.unnamed && one.effects.empty(); });
  if (unknown == all.end()) {
    all.emplace_back().unnamed = true;
    unknown = std::prev(all.end());
  }
  for (Hypothesis& one : all) {
    if (one.unnamed || !shows_in_gap(one)) continue;
    unknown->probability += kImitatedPart * one.probability;
    one.probability *= 1.0 - kImitatedPart;
  }
  set_probabilities(comparison);
}

}  // namespace glidelab::diagnose
