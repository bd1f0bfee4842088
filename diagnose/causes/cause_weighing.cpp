#include "diagnose/causes/cause_weighing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/long_work.h"
#include "diagnose/causes/cause_odds.h"
#include "diagnose/causes/cause_sequence.h"
#include "diagnose/causes/parameter_prior.h"
#include "diagnose/causes/remainder.h"
#include "diagnose/causes/spread_prior.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/whitening.h"
#include "diagnose/unnamed/unnamed.h"
#include "diagnose/weigh/air_odds.h"
#include "diagnose/weigh/unknown_noise.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFirst =
    6;  // likeliest by the noise alone: the best gives the first remainder, and all are weighed
constexpr double kCostOfTakingTheBest = 3.0;  // ln 20: the likeliest of some twenty functions without a name is taken
constexpr std::size_t kProfiled = 14;         // explanations that get a remainder of their own
constexpr double kRemainderCost = 3.0;        // log evidence that a remainder costs, its sizes being unknown
constexpr double kNearlyAsLikely = 0.1;       // relative to the probability of the likeliest explanation
constexpr std::size_t kMostBeside = 8;        // explanations beside which a function without a name is weighed
constexpr std::size_t kWithScatter = 3;       // laws that are weighed together with clip scatter
constexpr double kMuchLeft = 0.1;             // of the excess: a law that leaves less needs no clip scatter beside it
constexpr int kMostSettling = 3;              // fits of an explanation beside its own remainder
constexpr double kSettledEvidence = 0.5;      // log evidence: a smaller change decides nothing
constexpr double kNotWeighed = 1e3;           // log evidence by which an explanation without a fit is behind

struct Profile {
  RemainderSpace::Best best;
  double chi2 = 0.0;
  double log_evidence = -std::numeric_limits<double>::infinity();
};

Profile profile_of(const TrackSet& set, const MotionFit& noise_alone, const RemainderSizes* start,
                   const RemainderExtra* extra = nullptr) {
  Profile profile;
  if (!std::isfinite(noise_alone.cost)) return profile;
  const RemainderSpace space(set, noise_alone, extra);
  profile.best = space.likeliest(start);
  profile.chi2 = space.chi2(profile.best.sizes);
  profile.log_evidence = profile.best.log_likelihood + log_prior(set, noise_alone, space.solve(profile.best.sizes));
  return profile;
}

/// A fit and its remainder.
struct Settled {
  MotionFit noise_alone;
  Profile profile;
};

/// An explanation at the minimum under its own remainder. The likelihood of a remainder is that of the linear
/// neighbourhood of a fit. A fit by the noise alone, or by the remainder of another explanation, may lie so far from
/// the minimum that the linear model promises what the motion cannot do, or hides what it can: the evidence of two
/// explanations would then differ by where their fits happen to stand.
Settled settled(const TrackSet& set, MotionFit from, const RemainderSizes& start) {
  Settled here{linearise_again(set, from), {}};
  here.profile = profile_of(set, here.noise_alone, &start);
  for (int round = 0; round < kMostSettling && std::isfinite(here.profile.log_evidence); ++round) {
    TrackSet with = set;
    add_remainder(here.noise_alone, here.profile.best.sizes, with);
    const MotionFit& at = here.noise_alone;
    const MotionFit anew = fit_motions(with, at.effects, at.at, at.late);
    if (!std::isfinite(anew.cost)) break;
    Settled next{linearise_again(set, anew), {}};
    next.profile = profile_of(set, next.noise_alone, &here.profile.best.sizes);
    if (!std::isfinite(next.profile.log_evidence)) break;
    const double change = std::abs(next.profile.log_evidence - here.profile.log_evidence);
    here = std::move(next);
    if (change < kSettledEvidence) break;
  }
  return here;
}

/// Takes off what a gain over the nominal model's chi² is worth less where few positions show the noise.
void allow_for_unknown_noise(const TrackSet& set, const Profile& nominal, Profile& profile) {
  const double gain = 0.5 * (nominal.chi2 - profile.chi2);
  profile.log_evidence -= lost_to_unknown_noise(few_positions(set), nominal.chi2, gain);
}

/// The columns of a family in units of the noise alone: undoes the part of the whitening that the remainder caused.
RemainderExtra extra_of(const TrackSet& with, const UnnamedFamily& family) {
  RemainderExtra extra{family.columns, family.tau};
  Eigen::Index row = 0;
  for (const TrackedMotion& motion : with.motions) {
    const auto n = static_cast<Eigen::Index>(motion.t_s.size());
    extra.columns.middleRows(row, n) = without_remainder(motion, extra.columns.middleRows(row, n));
    row += n;
  }
  if (!std::isfinite(extra.sd)) {  // one bump of fixed size
    double largest = 0.0;
    for (const double size : family.size) largest = std::max(largest, std::abs(size));
    extra.sd = largest;
  }
  return extra;
}

/// Log evidence of a fit with the likeliest function without a name beside it: one that all clips share, or one with a
/// size for each clip. Empty if there is none.
std::optional<double> unnamed_profile(const TrackSet& set, const TrackSet& with, const Profile& nominal,
                                      const MotionFit& noise_alone, const std::vector<UnnamedFamily>& families,
                                      const RemainderSizes& start) {
  std::optional<double> log;
  for (const UnnamedFamily* family : {likeliest_shared(families), likeliest_of_clips(families)}) {
    if (family == nullptr || !(family->tau > 0.0)) continue;
    const RemainderExtra extra = extra_of(with, *family);
    if (!(extra.sd > 0.0) || !extra.columns.allFinite()) continue;
    Profile profile = profile_of(set, noise_alone, &start, &extra);
    allow_for_unknown_noise(set, nominal, profile);
    log = std::max(log.value_or(-std::numeric_limits<double>::infinity()), profile.log_evidence - kCostOfTakingTheBest);
  }
  return log;
}

/// The hypothesis that consists of the effects of a fit and nothing else; null if there is none.
const Hypothesis* pure_of(const Comparison& comparison, int fit) {
  for (const Hypothesis& one : comparison.all) {
    if (one.fit != fit || one.unnamed) continue;
    std::vector<std::size_t> a = one.effects, b = comparison.fits[static_cast<std::size_t>(fit)].effects;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    // Missing frames are in a fit's times, not among its effects.
    std::erase(a, effect_index(ids::dropped_frames));
    std::erase(b, effect_index(ids::dropped_frames));
    if (a == b) return &one;
  }
  return nullptr;
}

/// Indices of the fits that are weighed anew: the nominal fit and those of the likeliest explanations.
std::vector<std::size_t> worth_profiling(const TrackSet& set, const Comparison& comparison) {
  std::vector<Hypothesis> fitted;
  for (const Hypothesis& one : comparison.all) {
    if (one.fit > 0 && !one.unnamed) fitted.push_back(one);
  }
  std::sort(fitted.begin(), fitted.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  std::vector<std::size_t> worth = {0};
  for (const Hypothesis& one : fitted) {
    const auto fit = static_cast<std::size_t>(one.fit);
    // Single effects are always weighed: a remainder of their own may suit them better than the common one.
    if (worth.size() >= kProfiled && one.effects.size() > 1 && !(set.through_air && is_drag_with_its_air(one.effects)))
      continue;
    if (std::find(worth.begin(), worth.end(), fit) == worth.end()) worth.push_back(fit);
  }
  return worth;
}

/// Adds the explanations that are likeliest by the noise alone, so that they are weighed beside a remainder too.
/// Returns the indices of the added fits.
std::set<int> add_likeliest_of(const Comparison& first, Comparison& comparison) {
  std::vector<Hypothesis> likeliest;
  for (const Hypothesis& one : first.all) {
    if (one.fit > 0 && !one.unnamed && pure_of(first, one.fit) == &one) likeliest.push_back(one);
  }
  std::sort(likeliest.begin(), likeliest.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  if (likeliest.size() > kFirst) likeliest.resize(kFirst);
  std::set<int> joined;
  for (Hypothesis& one : likeliest) {
    if (find(comparison, {one.effects.begin(), one.effects.end()}) != nullptr) continue;
    const auto fit = static_cast<int>(comparison.fits.size());
    comparison.fits.push_back(first.fits[static_cast<std::size_t>(one.fit)]);
    one.fit = fit;
    std::erase_if(comparison.all,
                  [&](const Hypothesis& other) { return !other.unnamed && other.effects == one.effects; });
    comparison.all.push_back(one);
    joined.insert(fit);
  }
  return joined;
}

/// The explanations beside which a function without a name is weighed: the nominal model, the two single effects and
/// the pair with the most evidence, and those that are nearly as likely as the likeliest. Of two explanations that do
/// equally well, both must get the evidence of such a function, or the other falls behind. Scatter of single positions
/// makes no gap, so a function beside it would only repeat the one beside the nominal model.
std::vector<Hypothesis> beside(const Comparison& comparison, const LeftExcess& excess) {
  std::vector<Hypothesis> result = {*pure_of(comparison, 0)};
  for (const std::size_t many : {2, 1}) {
    std::size_t left = many;
    for (const Hypothesis& one : leaders_of(comparison, 3 - many, comparison.all.size())) {
      if (left == 0 || std::any_of(one.effects.begin(), one.effects.end(), is_scatter)) continue;
      result.push_back(one);
      --left;
    }
  }
  Comparison so_far;
  so_far.all = comparison.all;
  so_far.odds = comparison.odds;
  so_far.air_odds = comparison.air_odds;
  weigh_beside_remainder(excess, so_far);
  double likeliest = 0.0;
  for (const Hypothesis& one : so_far.all) {  // by falling probability
    if (one.fit <= 0 || one.unnamed || std::any_of(one.effects.begin(), one.effects.end(), is_scatter)) continue;
    likeliest = std::max(likeliest, one.probability);
    if (one.probability < kNearlyAsLikely * likeliest || result.size() >= kMostBeside) break;
    const bool known =
        std::any_of(result.begin(), result.end(), [&](const auto& other) { return other.fit == one.fit; });
    const Hypothesis* pure = known ? nullptr : pure_of(comparison, one.fit);
    if (pure != nullptr) result.push_back(*pure);
  }
  return result;
}

/// Laws that all clips have in common and that leave much of the excess, by falling probability.
std::vector<Hypothesis> laws_that_leave_much(const Comparison& comparison, const LeftExcess& excess) {
  Comparison so_far;
  so_far.all = comparison.all;
  so_far.odds = comparison.odds;
  so_far.air_odds = comparison.air_odds;
  weigh_beside_remainder(excess, so_far);
  std::vector<Hypothesis> laws;
  for (const Hypothesis& one : so_far.all) {  // by falling probability
    if (laws.size() == kWithScatter) break;
    if (one.fit <= 0 || one.unnamed || one.effects.size() != 1) continue;
    if (!(one.left.value_or(0.0) >= kMuchLeft)) continue;
    if (!shows_in_motion(effect_list()[one.effects.front()].search) || follows_each_clip(one.effects.front())) continue;
    if (const Hypothesis* pure = pure_of(comparison, one.fit)) laws.push_back(*pure);
  }
  return laws;
}

/// The excess that the likeliest function without a name leaves on its own; NaN if there is none.
double unnamed_excess(const TrackSet& set, const Comparison& by_noise) {
  const UnnamedFamily* family = likeliest_shared(by_noise.unnamed);
  if (family == nullptr || set.clips.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const MotionFit& nominal = by_noise.fits.front();
  return held_out_excess(set, with_unnamed(set, nominal, *family));
}

/// The excess of a fall through air without any drag, if it is more than the nominal model's, whose K imitates the
/// drag.
std::optional<double> excess_without_drag(const TrackSet& set, double nominal) {
  if (!set.through_air) return {};
  const TrackSet no_drag = without_drag(set);
  return std::max(nominal, held_out_excess(no_drag, fit_nominal(no_drag)));
}

}  // namespace

WeighedCauses weigh_causes(const TrackSet& set, const Comparison& first, const std::set<std::size_t>& without, int jobs,
                           const ImageEvidence* images, const std::function<void(double)>& done) {
  // The remainder of the best explanation so far.
  std::vector<int> tried{0};
  std::vector<Hypothesis> by_evidence = first.all;
  std::sort(by_evidence.begin(), by_evidence.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  for (const Hypothesis& one : by_evidence) {
    if (one.fit <= 0 || tried.size() >= kFirst) continue;
    if (std::find(tried.begin(), tried.end(), one.fit) == tried.end()) tried.push_back(one.fit);
  }
  std::vector<Profile> profiles(tried.size());
  base::for_each_parallel(tried.size(), jobs, [&](std::size_t i) {
    profiles[i] = profile_of(set, first.fits[static_cast<std::size_t>(tried[i])], nullptr);
  });
  const auto best = std::max_element(profiles.begin(), profiles.end(), [](const Profile& a, const Profile& b) {
    return a.log_evidence < b.log_evidence;
  });
  const MotionFit& best_fit =
      first.fits[static_cast<std::size_t>(tried[static_cast<std::size_t>(best - profiles.begin())])];
  WeighedCauses weighed;
  weighed.set = set;
  const RemainderSizes sizes = best->best.sizes;
  add_remainder(best_fit, sizes, weighed.set);
  done(0.2);

  Comparison& comparison = weighed.comparison;
  const MotionFit& nominal = first.fits.front();
  const bool searched = held_out_excess(set, nominal) < kLargestExcess;
  if (!searched) {
    // Beside such a gap the noise is negligible, and a remainder would not change what is found.
    comparison = first;
    base::for_each_parallel(comparison.fits.size(), jobs, [&](std::size_t f) {
      comparison.fits[f] = linearise_again(weighed.set, comparison.fits[f]);
    });
  } else {
    const std::vector<std::size_t> left_out(without.begin(), without.end());
    comparison = compare_hypotheses(weighed.set, left_out, jobs, images, [&](double part) { done(0.2 + 0.5 * part); });
  }
  const std::set<int> also = add_likeliest_of(first, comparison);

  // Each fit gets a remainder of its own.
  std::vector<MotionFit> noise_alone(comparison.fits.size());
  profiles.assign(comparison.fits.size(), {});
  std::vector<std::size_t> worth = worth_profiling(set, comparison);
  for (const int fit : also) {
    const auto f = static_cast<std::size_t>(fit);
    if (std::find(worth.begin(), worth.end(), f) == worth.end()) worth.push_back(f);
  }
  LeftExcess excess;
  excess.of_fits.assign(comparison.fits.size(), std::numeric_limits<double>::quiet_NaN());
  base::for_each_parallel(worth.size(), jobs, [&](std::size_t k) {
    const std::size_t f = worth[k];
    if (!searched) {
      noise_alone[f] = linearise_again(set, comparison.fits[f]);
      profiles[f] = profile_of(set, noise_alone[f], &sizes);
      return;
    }
    Settled own = settled(set, comparison.fits[f], sizes);
    noise_alone[f] = std::move(own.noise_alone);
    profiles[f] = std::move(own.profile);
  });
  base::for_each_parallel(worth.size(), jobs, [&](std::size_t k) {
    const std::size_t f = worth[k];
    if (!std::isfinite(noise_alone[f].cost)) return;
    // A fit by the noise alone differs from one with a remainder. The one that leaves less counts.
    excess.of_fits[f] = held_out_excess(set, noise_alone[f]);
    if (f == 0 || !searched || also.contains(static_cast<int>(f))) return;
    const MotionFit anew = fit_motions(set, comparison.fits[f].effects, comparison.fits[f].at, comparison.fits[f].late);
    if (std::isfinite(anew.cost)) {
      excess.of_fits[f] = std::min(excess.of_fits[f], held_out_excess(set, anew));
    }
  });
  for (const std::size_t f : worth) allow_for_unknown_noise(set, profiles.front(), profiles[f]);
  done(0.9);
  // Functions without a name alone and beside the likeliest explanations, each with a remainder of its own. Those of
  // the search stand beside what was best with the common remainder, so they are not comparable.
  std::erase_if(comparison.all, [](const Hypothesis& one) { return one.unnamed && one.fit > 0; });
  const double nothing = profiles.front().log_evidence;
  for (Hypothesis& one : comparison.all) {
    const int fit = one.fit >= 0 ? one.fit : one.effects.empty() ? 0 : -1;
    const Hypothesis* pure = fit >= 0 ? pure_of(comparison, fit) : nullptr;
    one.unnamed_log_evidence = pure != nullptr && !one.unnamed ? one.log_evidence - pure->log_evidence : 0.0;
  }
  for (Hypothesis& one : comparison.all) {
    const int fit = one.fit >= 0 ? one.fit : one.effects.empty() ? 0 : -1;
    const double profile = fit < 0 ? 0.0 : profiles[static_cast<std::size_t>(fit)].log_evidence;
    one.log_evidence = fit < 0 || one.unnamed || !std::isfinite(profile)
                           ? -kNotWeighed
                           : profile - nothing + std::exchange(one.unnamed_log_evidence, 0.0);
  }
  std::erase_if(comparison.all, [](const Hypothesis& one) { return one.unnamed; });
  excess.of_unnamed = unnamed_excess(set, first);
  excess.without_drag = excess_without_drag(set, excess.of_fits.front());
  set_air_odds(weighed.set, comparison);
  if (const std::size_t scatter = effect_index(ids::clip_scatter); searched && !without.contains(scatter)) {
    std::vector<Hypothesis> laws = laws_that_leave_much(comparison, excess);
    const auto by_noise = [&](std::size_t fit) {  // the weighed fits stand at the minimum beside their remainder
      const MotionFit& of = noise_alone[fit];
      return fit_motions(set, of.effects, of.at, of.late);
    };
    std::vector<std::optional<MotionFit>> pairs(laws.size());
    std::vector<double> without_it(laws.size());  // chi² of each law by the noise alone
    base::for_each_parallel(laws.size(), jobs, [&](std::size_t k) {
      const MotionFit law = by_noise(static_cast<std::size_t>(laws[k].fit));
      without_it[k] = law.cost;
      if (std::isfinite(law.cost)) pairs[k] = with_clip_scatter(set, law);
    });
    // Where clips scatter most of all, the law shows beside the scatter alone.
    const Hypothesis* alone = find(comparison, {scatter});
    const auto is_weighed = [&](int fit) {
      return fit >= 0 && std::isfinite(profiles[static_cast<std::size_t>(fit)].log_evidence);
    };
    if (alone != nullptr && is_weighed(alone->fit)) {
      const auto fit = static_cast<std::size_t>(alone->fit);
      std::set<std::size_t> others = without;
      for (const Hypothesis& law : laws) others.insert(law.effects.front());
      const MotionFit clips = by_noise(fit);
      for (MotionFit& pair : laws_beside_scatter(set, clips, profiles[fit].best.sizes, others)) {
        laws.push_back(*alone);
        laws.back().effects = {pair.effects.back()};
        pairs.emplace_back(std::move(pair));
        without_it.push_back(clips.cost);
      }
    }
    std::vector<std::optional<Settled>> found(laws.size());
    base::for_each_parallel(laws.size(), jobs, [&](std::size_t k) {
      if (pairs[k]) found[k] = settled(set, *pairs[k], profiles[static_cast<std::size_t>(laws[k].fit)].best.sizes);
    });
    for (std::size_t k = 0; k < laws.size(); ++k) {
      if (!found[k]) continue;
      const std::size_t fit = comparison.fits.size();
      excess.of_fits.push_back(std::min(held_out_excess(set, *pairs[k]), held_out_excess(set, found[k]->noise_alone)));
      noise_alone.push_back(std::move(found[k]->noise_alone));
      profiles.push_back(std::move(found[k]->profile));
      allow_for_unknown_noise(set, profiles.front(), profiles.back());
      comparison.fits.push_back(linearise_again(weighed.set, *pairs[k]));
      worth.push_back(fit);
      Hypothesis both = laws[k];
      both.effects.push_back(scatter);
      both.fit = static_cast<int>(fit);
      both.converged = pairs[k]->converged;
      both.gain += std::max(0.0, 0.5 * (without_it[k] - pairs[k]->cost));
      both.log_evidence =
          std::isfinite(profiles[fit].log_evidence) ? profiles[fit].log_evidence - nothing : -kNotWeighed;
      std::erase_if(comparison.all, [&](const Hypothesis& one) {
        return std::set(one.effects.begin(), one.effects.end()) == std::set(both.effects.begin(), both.effects.end());
      });
      comparison.all.push_back(std::move(both));
    }
    set_air_odds(weighed.set, comparison);  // of the fits that were added
  }
  const std::vector<Hypothesis> leaders = beside(comparison, excess);
  std::vector<std::vector<UnnamedFamily>> found(leaders.size());
  std::vector<std::optional<double>> logs(leaders.size());
  base::for_each_parallel(leaders.size(), jobs, [&](std::size_t k) {
    const auto fit = static_cast<std::size_t>(leaders[k].fit);
    found[k] = fit == 0 ? comparison.unnamed : unnamed_families(ScoreSpace(weighed.set, comparison.fits[fit]));
    logs[k] = unnamed_profile(set, weighed.set, profiles.front(), noise_alone[fit], found[k], profiles[fit].best.sizes);
  });
  for (std::size_t k = 0; k < leaders.size(); ++k) {
    const Hypothesis& named = leaders[k];
    const auto fit = static_cast<std::size_t>(named.fit);
    const std::optional<double>& log = logs[k];
    if (!log) continue;
    Hypothesis both = named;
    both.unnamed = true;
    both.unnamed_log_evidence = *log - profiles[fit].log_evidence;
    both.log_evidence = *log - nothing;
    comparison.all.push_back(both);
    if (fit > 0 && comparison.beside_fit == 0) {
      comparison.beside_fit = comparison.left_fit = named.fit;
      comparison.unnamed_left = std::move(found[k]);
    }
  }
  weigh_beside_remainder(excess, comparison);
  weighed.fits.resize(comparison.fits.size());
  for (const std::size_t f : worth) {
    if (std::isfinite(profiles[f].log_evidence)) {
      weighed.fits[f] = WeighedFit{std::move(noise_alone[f]), profiles[f].best.sizes};
    }
  }
  done(1.0);
  return weighed;
}

void allow_for_remainders(const TrackSet& set, const std::set<std::size_t>& without, int jobs, Comparison& comparison) {
  std::vector<Hypothesis*> worth;
  for (Hypothesis& one : comparison.all) {
    if (one.unnamed || (one.fit < 0 && !one.effects.empty())) continue;
    if (one.effects.empty() || worth.size() < kProfiled) worth.push_back(&one);
  }
  std::vector<double> gains(worth.size(), 0.0);
  base::for_each_parallel(worth.size(), jobs, [&](std::size_t k) {
    const MotionFit& fit = comparison.fits[static_cast<std::size_t>(std::max(0, worth[k]->fit))];
    const RemainderSpace space(set, fit);
    gains[k] =
        std::max(0.0, space.likeliest().log_likelihood - space.log_likelihood(RemainderSizes{}) - kRemainderCost);
  });
  for (std::size_t k = 0; k < worth.size(); ++k) worth[k]->log_evidence += gains[k];
  weigh(set, without, comparison);
}

}  // namespace glidelab::diagnose
