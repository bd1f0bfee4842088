#include "diagnose/weigh/hypothesis.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/long_work.h"
#include "base/math/dense.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/gap/held_out.h"

namespace glidelab::diagnose {
namespace {

constexpr double kWorthFitting = 1.0;    // log likelihood that a scan must gain to be worth a full fit
constexpr double kSameDirection = 1e-3;  // of sin²: above this it is another law, however small the effect
constexpr double kSameGain = 0.5;        // log likelihood
constexpr double kNoFit = 1e6;           // log evidence that an explanation without a fit lacks

std::size_t alike_of(const Comparison& comparison, std::size_t effect, bool filmed) {
  return comparison.alike.empty() ? first_alike(effect, filmed) : comparison.alike[effect];
}

bool is_named(const Hypothesis& hypothesis) {
  return !hypothesis.unnamed && !hypothesis.effects.empty();
}

using Causes = std::multiset<std::size_t>;  // each effect by the first one that is like it

Causes causes_of(const Comparison& comparison, const Hypothesis& hypothesis, bool filmed) {
  Causes causes;
  for (const std::size_t e : hypothesis.effects) causes.insert(alike_of(comparison, e, filmed));
  return causes;
}

/// The probability of each cause: the sum over the explanations that contain it. Scatter counts only by itself.
std::map<std::size_t, double> probabilities_of_causes(const Comparison& comparison, bool filmed) {
  std::map<std::size_t, double> sums;
  for (const Hypothesis& one : comparison.all) {
    if (!is_named(one)) continue;
    const Causes of = causes_of(comparison, one, filmed);
    for (const std::size_t cause : std::set<std::size_t>(of.begin(), of.end())) {
      if (!is_scatter(cause) || is_scatter_alone(one)) sums[cause] += one.probability;
    }
  }
  return sums;
}

}  // namespace

double price_of_spread(const MotionFit& fit, std::size_t effect) {
  if (effect_list()[effect].search != Search::spread || !fit.layout || !std::isfinite(fit.cost)) return 0.0;
  const Eigen::MatrixXd covariance = common_covariance(fit);
  const auto& globals = fit.layout->globals();
  std::vector<Eigen::Index> sizes;
  std::vector<double> units;
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].kind != ParameterLayout::Global::Kind::effect || globals[g].effect != effect) continue;
    sizes.push_back(static_cast<Eigen::Index>(g));
    units.push_back(globals[g].parameter->held_sd);
  }
  const auto unit = Eigen::Map<const Eigen::VectorXd>(units.data(), std::ssize(units));
  const Eigen::VectorXd found = fit.at.global(sizes).cwiseQuotient(unit);
  // In units of the prior, whose own information is 1.
  Eigen::MatrixXd products = base::inverse_positive(
      Eigen::MatrixXd(unit.cwiseInverse().asDiagonal() * covariance(sizes, sizes) * unit.cwiseInverse().asDiagonal()));
  products.diagonal().array() -= 1.0;
  // What these data cannot show at its usual size costs nothing, and rounding is all that is left of it.
  if (!(products.diagonal().maxCoeff() >= kVisible_sd * kVisible_sd)) return 0.0;
  const SpreadEvidence evidence = log_spread_evidence(products, base::product(products, found));
  return std::min(0.0, evidence.log_evidence - evidence.free_gain);
}

double log_evidence_beyond(const TrackSet& set, const MotionFit& base, const EffectScan& scan, const MotionFit& fit) {
  const double gain = 0.5 * (base.cost - fit.cost);
  const bool in_place_of_k = takes_place_of_drag(set, base.effects, scan.effect);
  if (!std::isfinite(gain)) return in_place_of_k ? -kNoFit : std::min(0.0, scan.log_evidence - scan.gain);
  return in_place_of_k ? gain : gain + std::min(scan.log_evidence - scan.gain, price_of_spread(fit, scan.effect));
}

Found fit_more(const TrackSet& set, const MotionFit& base, const EffectScan& scan, const Hypothesis& beside) {
  Found found;
  found.fit = fit_with_effect(set, base, scan.effect, with_effect(set, base, scan.effect, scan.values, scan.own));
  const double gain = 0.5 * (base.cost - found.fit.cost);
  found.hypothesis.effects = beside.effects;  // missing frames are in the fit's times, not among its effects
  found.hypothesis.effects.push_back(scan.effect);
  found.hypothesis.gain = beside.gain + gain;
  found.hypothesis.log_evidence = beside.log_evidence + log_evidence_beyond(set, base, scan, found.fit);
  return found;
}

void add(Comparison& comparison, Found found) {
  found.hypothesis.converged = found.fit.converged;
  std::set<std::size_t> members(found.hypothesis.effects.begin(), found.hypothesis.effects.end());
  for (Hypothesis& other : comparison.all) {
    if (other.unnamed || std::set<std::size_t>(other.effects.begin(), other.effects.end()) != members) continue;
    if (other.log_evidence >= found.hypothesis.log_evidence) return;
    found.hypothesis.fit = static_cast<int>(comparison.fits.size());
    comparison.fits.push_back(std::move(found.fit));
    other = found.hypothesis;
    return;
  }
  found.hypothesis.fit = static_cast<int>(comparison.fits.size());
  comparison.fits.push_back(std::move(found.fit));
  comparison.all.push_back(found.hypothesis);
}

std::vector<const EffectScan*> best_of(const std::vector<EffectScan>& scans, std::size_t most) {
  std::vector<const EffectScan*> best;
  for (const EffectScan& scan : scans) {
    if (scan.visible && scan.gain > kWorthFitting && !scan.values.empty()) best.push_back(&scan);
  }
  std::sort(best.begin(), best.end(), [](const auto* a, const auto* b) { return a->log_evidence > b->log_evidence; });
  if (best.size() > most) best.resize(most);
  return best;
}

std::vector<Hypothesis> leaders_of(const Comparison& comparison, std::size_t size, std::size_t most) {
  std::vector<Hypothesis> leaders;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.effects.size() == size && hypothesis.fit >= 0 && !hypothesis.unnamed) leaders.push_back(hypothesis);
  }
  std::sort(leaders.begin(), leaders.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  if (leaders.size() > most) leaders.resize(most);
  return leaders;
}

void fit_best(const TrackSet& set, const MotionFit& base, const std::vector<const EffectScan*>& best,
              const Hypothesis& beside, const Work& work, Comparison& comparison) {
  std::vector<Found> found(best.size());
  base::for_each_parallel(best.size(), work.jobs, [&](std::size_t i) {
    work.look();
    found[i] = fit_more(set, base, *best[i], beside);
  });
  for (Found& one : found) add(comparison, std::move(one));
}

const Hypothesis* find(const Comparison& comparison, const std::set<std::size_t>& effects) {
  for (const Hypothesis& one : comparison.all) {
    if (one.unnamed || one.fit < 0 || one.effects.size() != effects.size()) continue;
    if (std::set<std::size_t>(one.effects.begin(), one.effects.end()) == effects) return &one;
  }
  return nullptr;
}

void set_probabilities(Comparison& comparison) {
  comparison.effect_probability.assign(effect_list().size(), 0.0);
  comparison.none = comparison.unknown = 0.0;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.unnamed) {
      comparison.unknown += hypothesis.probability;
    } else if (hypothesis.effects.empty()) {
      comparison.none += hypothesis.probability;
    } else {
      for (const std::size_t e : hypothesis.effects) comparison.effect_probability[e] += hypothesis.probability;
    }
  }
  std::stable_sort(comparison.all.begin(), comparison.all.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
}

std::vector<std::size_t> alike_in(const ScoreSpace& space, const std::vector<EffectScan>& scans) {
  const auto has_direction = [](const EffectScan& scan) { return scan.visible && scan.direction.rest.size() > 0; };
  std::vector<std::size_t> alike(effect_list().size());
  for (std::size_t e = 0; e < alike.size(); ++e) {
    const std::size_t first = first_alike(e, space.set().images);  // it comes earlier in the list
    alike[e] = first != e ? alike[first] : e;
    if (first != e || !has_direction(scans[e])) continue;
    const EffectScan& scan = scans[e];
    for (std::size_t other = 0; other < e; ++other) {
      if (alike[other] != other || !has_direction(scans[other])) continue;
      const ScoreColumn &a = scan.direction, &b = scans[other].direction;
      const double ab = space.dot(a, b), both = space.dot(a, a) * space.dot(b, b);
      if (!(both > 0.0)) continue;
      const double sine2 = std::max(0.0, 1.0 - ab * ab / both);
      if (sine2 > kSameDirection || std::max(scan.gain, scans[other].gain) * sine2 > kSameGain) continue;
      alike[e] = other;
      break;
    }
  }
  return alike;
}

bool shows_in_gap(const Hypothesis& hypothesis, const std::set<std::size_t>& except) {
  return std::any_of(hypothesis.effects.begin(), hypothesis.effects.end(),
                     [&](std::size_t e) { return takes_part_of_gap(effect_list()[e].search) && !except.contains(e); });
}

bool has(const Hypothesis& hypothesis, std::size_t effect) {
  return std::find(hypothesis.effects.begin(), hypothesis.effects.end(), effect) != hypothesis.effects.end();
}

double probability_of_any(const Comparison& comparison, const std::vector<std::size_t>& effects) {
  double sum = 0.0;
  for (const Hypothesis& one : comparison.all) {
    const bool any = std::any_of(effects.begin(), effects.end(), [&](std::size_t e) { return has(one, e); });
    if (any && !one.unnamed) sum += one.probability;
  }
  return sum;
}

bool is_drag_with_its_air(const std::vector<std::size_t>& effects) {
  const std::set<std::size_t> all(effects.begin(), effects.end());
  return all.contains(effect_index(ids::quadratic_drag)) && all.contains(effect_index(ids::rotational_inertia));
}

double log_prior_odds(const Comparison& comparison, const Hypothesis& hypothesis) {
  double log = 0.0;
  if (!comparison.fit_odds.empty()) {  // an effect without a fit is one beside the nominal drag
    log += comparison.fit_odds[static_cast<std::size_t>(std::max(0, hypothesis.fit))];
  }
  if (comparison.odds.empty()) return log;
  for (const std::size_t e : hypothesis.effects) log += std::log(comparison.odds[e]);
  return log;
}

bool are_alike(const Comparison& comparison, std::size_t one, std::size_t other, bool filmed) {
  return alike_of(comparison, one, filmed) == alike_of(comparison, other, filmed);
}

bool is_scatter(std::size_t effect) {
  return effect_list()[effect].search == Search::noise;
}

bool is_scatter_alone(const Hypothesis& hypothesis) {
  return !hypothesis.unnamed && !hypothesis.effects.empty() &&
         std::all_of(hypothesis.effects.begin(), hypothesis.effects.end(), is_scatter);
}

namespace {

/// The leading cause, and one after another those that act in more than half of what has all of them so far.
Causes with_likely_others(std::size_t leading, const std::map<Causes, double>& sums) {
  Causes likely = {leading};
  while (true) {
    double all = 0.0;
    std::map<std::size_t, double> beside;
    for (const auto& [causes, probability] : sums) {
      if (!std::includes(causes.begin(), causes.end(), likely.begin(), likely.end())) continue;
      all += probability;
      for (auto cause = causes.begin(); cause != causes.end(); cause = causes.upper_bound(*cause)) {
        if (!likely.contains(*cause) && !is_scatter(*cause)) beside[*cause] += probability;
      }
    }
    const auto next = std::max_element(beside.begin(), beside.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (next == beside.end() || next->second <= 0.5 * all) return likely;
    likely.insert(next->first);
  }
}

}  // namespace

const Hypothesis* best_named(const TrackSet& set, const Comparison& comparison) {
  const std::map<std::size_t, double> of_cause = probabilities_of_causes(comparison, set.images);
  if (of_cause.empty()) return nullptr;
  const std::size_t leading = std::max_element(of_cause.begin(), of_cause.end(), [](const auto& a, const auto& b) {
                                return a.second < b.second;
                              })->first;
  std::map<Causes, double> sums;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (is_named(hypothesis)) sums[causes_of(comparison, hypothesis, set.images)] += hypothesis.probability;
  }
  const Causes likely = with_likely_others(leading, sums);
  const Hypothesis* best = nullptr;  // the likeliest name of the likeliest causes: they are sorted by decreasing
                                     // probability
  double most = -1.0;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (!is_named(hypothesis)) continue;
    const Causes of = causes_of(comparison, hypothesis, set.images);
    if (!std::includes(of.begin(), of.end(), likely.begin(), likely.end()) || sums[of] <= most) continue;
    most = sums[of];
    best = &hypothesis;
  }
  return best;
}

}  // namespace glidelab::diagnose
