#include "diagnose/causes/cause_weighing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/long_work.h"
#include "diagnose/causes/cause_odds.h"
#include "diagnose/causes/cause_sequence.h"
#include "diagnose/causes/chosen_explanations.h"
#include "diagnose/causes/explanation_profile.h"
#include "diagnose/causes/further_causes.h"
#include "diagnose/causes/remainder.h"
#include "diagnose/causes/scatter_structure.h"
#include "diagnose/causes/unnamed_profile.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/unnamed/unnamed.h"
#include "diagnose/weigh/fit_odds.h"

namespace glidelab::diagnose {
namespace {

constexpr double kRemainderCost = 3.0;  // log evidence that a remainder costs, its sizes being unknown
constexpr std::size_t kWithHand = 4;    // explanations that are weighed together with a hand,
constexpr std::size_t kWithStated = 2;  // and with each cause that is known by stated inclinations
constexpr double kNotWeighed = 1e3;     // log evidence by which an explanation without a fit is behind

/// Adds the explanations that are likeliest by the noise alone, so that they are weighed beside a remainder too.
/// Returns the indices of the added fits.
std::set<int> add_likeliest_of(const Comparison& first, Comparison& comparison) {
  std::vector<Hypothesis> likeliest;
  for (const Hypothesis& one : first.all) {
    if (one.fit > 0 && !one.unnamed && pure_of(first, one.fit) == &one) likeliest.push_back(one);
  }
  std::sort(likeliest.begin(), likeliest.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  if (likeliest.size() > kMostByNoise) likeliest.resize(kMostByNoise);
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

/// What these fits by the noise alone leave of the held-out excess.
std::vector<double> excess_of(const TrackSet& set, const Comparison& first, const std::vector<std::size_t>& fits,
                              int jobs) {
  std::vector<double> left(fits.size());
  base::for_each_parallel(fits.size(), jobs,
                          [&](std::size_t i) { left[i] = held_out_excess(set, first.fits[fits[i]]); });
  return left;
}

/// An explanation that is fitted together with a further cause.
struct WithFurther {
  Hypothesis of;
  MotionFit both;
  double chi2_without = 0.0;  ///< by the noise alone, of the fit to which the other of the two was added
  std::size_t further = 0;    ///< the effect
};

/// Those that were found.
std::vector<WithFurther> found_of(std::vector<std::optional<WithFurther>> tried) {
  std::vector<WithFurther> found;
  for (std::optional<WithFurther>& one : tried) {
    if (one) found.push_back(std::move(*one));
  }
  return found;
}

/// One weighing: what its steps share, and the steps in the order in which run() takes them.
class CauseWeighing {
 public:
  CauseWeighing(const TrackSet& set, const Comparison& first, const std::set<std::size_t>& without, int jobs)
      : set_(set),
        first_(first),
        without_(without),
        jobs_(jobs),
        likeliest_by_noise_(likeliest_fits(first)),
        searched_(!noise_is_negligible(excess_of(set, first, likeliest_by_noise_, jobs))) {
    weighed_.set = set;
  }

  WeighedCauses run(const ImageEvidence* images, const std::function<void(double)>& done) {
    count_first_remainder_as_noise();
    done(0.2);
    compare_again(images, done);
    profile_each();
    measure_excess();
    find_causes_by_stated();
    done(0.9);
    take_own_evidence();
    find_structure_in_scatter();
    if (searched_ && !without_.contains(scatter_)) add_laws_with_clip_scatter();
    if (searched_ && !without_.contains(hand_))
      add_all(beside_likeliest({hand_}, kWithHand, [](const MotionFit&) { return true; }));
    if (searched_) {
      add_all(beside_likeliest(comparison().by_stated, kWithStated,
                               [](const MotionFit& law) { return chi2_of_stated(law) > kClearInStated; }));
    }
    add_functions_without_name();
    weigh_beside_remainder(excess_, comparison());
    done(1.0);
    return finished();
  }

 private:
  Comparison& comparison() { return weighed_.comparison; }
  double evidence_of_nominal() const { return profiles_.front().log_evidence; }
  bool is_weighed(int fit) const {
    return fit >= 0 && std::isfinite(profiles_[static_cast<std::size_t>(fit)].log_evidence);
  }
  const RemainderSizes& sizes_of(const Hypothesis& one) const {
    return profiles_[static_cast<std::size_t>(one.fit)].best.sizes;
  }

  void count_first_remainder_as_noise();
  void compare_again(const ImageEvidence* images, const std::function<void(double)>& done);
  void start_from_noise_alone();
  void share_lost_frames();
  void profile_each();
  void measure_excess();
  void find_causes_by_stated();
  void take_own_evidence();
  void find_structure_in_scatter();
  void add_laws_with_clip_scatter();
  std::vector<WithFurther> scatter_beside(const std::vector<Hypothesis>& laws) const;
  std::vector<WithFurther> beside_scatter_alone(const std::vector<Hypothesis>& laws);
  std::vector<WithFurther> beside_likeliest(const std::set<std::size_t>& effects, std::size_t most,
                                            bool (*lacks)(const MotionFit&)) const;
  void add_all(std::vector<WithFurther> found);
  void add(WithFurther with, Settled settled);
  void add_functions_without_name();
  WeighedCauses finished();

  const std::size_t scatter_ = effect_index(ids::clip_scatter), hand_ = effect_index(ids::late_release);
  const TrackSet& set_;      // the noise alone
  const Comparison& first_;  // by the noise alone
  const std::set<std::size_t>& without_;
  const int jobs_;
  const std::vector<std::size_t> likeliest_by_noise_;  // fits
  const bool searched_;  // where the noise is negligible, a remainder would not change what is found
  WeighedCauses weighed_;
  RemainderSizes first_remainder_;
  std::set<int> likeliest_before_;      // fits that are weighed because they are likeliest by the noise alone
  std::vector<std::size_t> worth_;      // fits that get a remainder of their own
  std::vector<MotionFit> noise_alone_;  // of each fit of the comparison, as the next two
  std::vector<Profile> profiles_;
  LeftExcess excess_;
};

/// The remainder of the best explanation so far becomes noise of the motions.
void CauseWeighing::count_first_remainder_as_noise() {
  const std::vector<std::size_t>& tried = likeliest_by_noise_;
  std::vector<Profile> profiles(tried.size());
  base::for_each_parallel(tried.size(), jobs_,
                          [&](std::size_t i) { profiles[i] = profile_of(set_, first_.fits[tried[i]], nullptr); });
  const auto best = std::max_element(profiles.begin(), profiles.end(), [](const Profile& a, const Profile& b) {
    return a.log_evidence < b.log_evidence;
  });
  first_remainder_ = best->best.sizes;
  add_remainder(first_.fits[tried[static_cast<std::size_t>(best - profiles.begin())]], first_remainder_, weighed_.set);
}

/// The explanations of the motions with that remainder, and those that are likeliest by the noise alone.
void CauseWeighing::compare_again(const ImageEvidence* images, const std::function<void(double)>& done) {
  if (searched_) {
    const std::vector<std::size_t> left_out(without_.begin(), without_.end());
    comparison() =
        compare_hypotheses(weighed_.set, left_out, jobs_, images, [&](double part) { done(0.2 + 0.5 * part); });
  } else {
    comparison() = first_;
    base::for_each_parallel(comparison().fits.size(), jobs_, [&](std::size_t f) {
      comparison().fits[f] = linearise_again(weighed_.set, comparison().fits[f]);
    });
  }
  if (searched_) start_from_noise_alone();
  if (searched_) share_lost_frames();
  likeliest_before_ = add_likeliest_of(first_, comparison());
}

/// Beside a large remainder a search may stop at a poor minimum where the same search by the noise alone did not: each
/// fit is made again from there if that fits better.
void CauseWeighing::start_from_noise_alone() {
  const auto sorted = [](std::vector<std::size_t> effects) {
    std::sort(effects.begin(), effects.end());
    return effects;
  };
  std::map<std::vector<std::size_t>, const MotionFit*> by_effects;
  for (const MotionFit& fit : first_.fits) by_effects.emplace(sorted(fit.effects), &fit);
  std::vector<MotionFit>& fits = comparison().fits;
  base::for_each_parallel(fits.size(), jobs_, [&](std::size_t f) {
    const auto same = by_effects.find(sorted(fits[f].effects));
    if (same == by_effects.end() || !std::isfinite(same->second->cost)) return;
    const MotionFit from = linearise_again(weighed_.set, *same->second);
    if (!(from.cost < fits[f].cost)) return;
    MotionFit anew = fit_motions(weighed_.set, from.effects, from.at, from.late);
    if (anew.cost < fits[f].cost) fits[f] = std::move(anew);
  });
}

/// A remainder may hide missing frames that were found beside another effect, or by the noise alone. Of all that were
/// found, those are taken with which missing frames alone follow the motion best by the noise alone.
void CauseWeighing::share_lost_frames() {
  std::vector<MotionFit>& fits = comparison().fits;
  const auto alone = std::find_if(fits.begin(), fits.end(),
                                  [](const MotionFit& fit) { return fit.effects.empty() && !fit.late.empty(); });
  if (alone == fits.end()) return;
  std::vector<MotionFit> found = fits;
  found.insert(found.end(), first_.fits.begin(), first_.fits.end());
  const std::optional<MotionFit> best = lost_frames_alone(set_, found, jobs_);
  if (best && best->late != alone->late) *alone = linearise_again(weighed_.set, *best);
}

/// A remainder of its own for each explanation that is worth it.
void CauseWeighing::profile_each() {
  noise_alone_.resize(comparison().fits.size());
  profiles_.resize(comparison().fits.size());
  worth_ = worth_profiling(set_, comparison());
  for (const int fit : likeliest_before_) {
    const auto f = static_cast<std::size_t>(fit);
    if (std::find(worth_.begin(), worth_.end(), f) == worth_.end()) worth_.push_back(f);
  }
  base::for_each_parallel(worth_.size(), jobs_, [&](std::size_t k) {
    const std::size_t f = worth_[k];
    if (!searched_) {
      noise_alone_[f] = linearise_again(set_, comparison().fits[f]);
      profiles_[f] = profile_of(set_, noise_alone_[f], &first_remainder_);
      return;
    }
    Settled own = settled(set_, comparison().fits[f], first_remainder_);
    noise_alone_[f] = std::move(own.noise_alone);
    profiles_[f] = std::move(own.profile);
  });
  for (const std::size_t f : worth_) allow_for_unknown_noise(set_, profiles_.front(), profiles_[f]);
}

/// What each explanation leaves of the gap. A fit by the noise alone differs from one with a remainder: the one that
/// leaves less counts.
void CauseWeighing::measure_excess() {
  excess_.of_fits.assign(comparison().fits.size(), std::numeric_limits<double>::quiet_NaN());
  base::for_each_parallel(worth_.size(), jobs_, [&](std::size_t k) {
    const std::size_t f = worth_[k];
    if (!std::isfinite(noise_alone_[f].cost)) return;
    double& of_fit = excess_.of_fits[f];
    of_fit = held_out_excess(set_, noise_alone_[f]);
    if (f == 0 || !searched_ || likeliest_before_.contains(static_cast<int>(f))) return;
    const MotionFit& with = comparison().fits[f];
    const MotionFit anew = fit_motions(set_, with.effects, with.at, with.late);
    if (std::isfinite(anew.cost)) of_fit = std::min(of_fit, held_out_excess(set_, anew));
  });
  excess_.of_unnamed = unnamed_excess(set_, first_);
  excess_.without_drag = excess_without_drag(set_, excess_.of_fits.front());
}

/// The effects that are known by stated inclinations and not by the gap.
void CauseWeighing::find_causes_by_stated() {
  constexpr double kAllOfExcess = 0.9;  // an effect that leaves more of it is no cause of the gap
  const MotionFit& nominal = comparison().fits.front();
  for (const Hypothesis& one : comparison().all) {
    if (one.unnamed || one.effects.size() != 1 || one.fit <= 0) continue;
    const auto fit = static_cast<std::size_t>(one.fit);
    if (!(excess_.of_fits[fit] > kAllOfExcess * excess_.of_fits.front())) continue;
    if (gain_in_stated(nominal, comparison().fits[fit]) > kClearInStated)
      comparison().by_stated.insert(one.effects.front());
  }
}

/// Log evidences beside each explanation's own remainder, over that of the nominal model. Functions without a name that
/// the search found are dropped: they stand beside what was best with the common remainder.
void CauseWeighing::take_own_evidence() {
  std::vector<Hypothesis>& all = comparison().all;
  std::erase_if(all, [](const Hypothesis& one) { return one.unnamed && one.fit > 0; });
  const auto fit_of = [](const Hypothesis& one) { return one.fit >= 0 ? one.fit : one.effects.empty() ? 0 : -1; };
  const auto by_positions = [](const Hypothesis& one) { return one.log_evidence - one.of_images; };
  for (Hypothesis& one : all) {
    const Hypothesis* pure = fit_of(one) >= 0 ? pure_of(comparison(), fit_of(one)) : nullptr;
    one.unnamed_log_evidence = pure != nullptr && !one.unnamed ? by_positions(one) - by_positions(*pure) : 0.0;
  }
  for (Hypothesis& one : all) {
    const bool known = !one.unnamed && is_weighed(fit_of(one));
    one.log_evidence = known ? profiles_[static_cast<std::size_t>(fit_of(one))].log_evidence - evidence_of_nominal() +
                                   std::exchange(one.unnamed_log_evidence, 0.0) + one.of_images
                             : -kNotWeighed;
  }
  std::erase_if(all, [](const Hypothesis& one) { return one.unnamed; });
  set_fit_odds(weighed_.set, comparison());
}

/// A drift, or a friction or drag of each configuration, together with clips that scatter about it: the evidence of
/// clips that scatter, if their sizes follow it.
void CauseWeighing::find_structure_in_scatter() {
  const Hypothesis* clips = find(comparison(), {scatter_});
  if (clips == nullptr || !is_weighed(clips->fit)) return;
  const MotionFit& fit = noise_alone_[static_cast<std::size_t>(clips->fit)];
  const double of_clips = clips->log_evidence - clips->of_images;
  for (Hypothesis& one : comparison().all) {
    if (one.unnamed || one.effects.size() != 1 || !is_weighed(one.fit)) continue;
    const std::optional<double> gain = gain_of_structure(set_, fit, sizes_of(*clips), one.effects.front());
    if (gain) one.log_evidence = std::max(one.log_evidence, of_clips + *gain + one.of_images);
  }
}

/// The likeliest laws that leave much of the gap, each together with clip scatter.
void CauseWeighing::add_laws_with_clip_scatter() {
  const std::vector<Hypothesis> laws = laws_that_leave_much(comparison(), excess_);
  std::vector<WithFurther> pairs = scatter_beside(laws);
  for (WithFurther& pair : beside_scatter_alone(laws)) pairs.push_back(std::move(pair));
  add_all(std::move(pairs));
}

void CauseWeighing::add_all(std::vector<WithFurther> found) {
  std::vector<Settled> own(found.size());
  base::for_each_parallel(found.size(), jobs_,
                          [&](std::size_t k) { own[k] = settled(set_, found[k].both, sizes_of(found[k].of)); });
  for (std::size_t k = 0; k < found.size(); ++k) add(std::move(found[k]), std::move(own[k]));
  set_fit_odds(weighed_.set, comparison());  // of the fits that were added
}

/// A weighed fit at its minimum by the noise alone; it stands at the one beside its remainder.
MotionFit by_noise(const TrackSet& set, const MotionFit& of) {
  return fit_motions(set, of.effects, of.at, of.late);
}

std::vector<WithFurther> CauseWeighing::scatter_beside(const std::vector<Hypothesis>& laws) const {
  std::vector<std::optional<WithFurther>> found(laws.size());
  base::for_each_parallel(laws.size(), jobs_, [&](std::size_t k) {
    const MotionFit law = by_noise(set_, noise_alone_[static_cast<std::size_t>(laws[k].fit)]);
    if (!std::isfinite(law.cost)) return;
    if (std::optional<MotionFit> both = with_clip_scatter(set_, law))
      found[k] = {laws[k], std::move(*both), law.cost, scatter_};
  });
  return found_of(std::move(found));
}

/// The likeliest explanations that lack one of these effects, at most so many, each with each of them.
std::vector<WithFurther> CauseWeighing::beside_likeliest(const std::set<std::size_t>& effects, std::size_t most,
                                                         bool (*lacks)(const MotionFit&)) const {
  struct Tried {
    Hypothesis law;
    std::size_t further = 0;
  };
  std::vector<Tried> tried;
  for (const Hypothesis& one :
       effects.empty() ? std::vector<Hypothesis>() : likeliest_laws(weighed_.comparison, excess_)) {
    const bool has_one = std::any_of(effects.begin(), effects.end(), [&](std::size_t e) { return has(one, e); });
    if (has_one || !is_weighed(one.fit) || !lacks(noise_alone_[static_cast<std::size_t>(one.fit)])) continue;
    for (const std::size_t e : effects) {
      std::set<std::size_t> both(one.effects.begin(), one.effects.end());
      both.insert(e);
      if (tried.size() < most * effects.size() && find(weighed_.comparison, both) == nullptr) tried.push_back({one, e});
    }
  }
  std::vector<std::optional<WithFurther>> found(tried.size());
  base::for_each_parallel(tried.size(), jobs_, [&](std::size_t k) {
    const auto& [of, further] = tried[k];
    const MotionFit law = by_noise(set_, noise_alone_[static_cast<std::size_t>(of.fit)]);
    std::optional<MotionFit> both = with_further(set_, law, further, sizes_of(of));
    if (both) found[k] = {of, std::move(*both), law.cost, further};
  });
  return found_of(std::move(found));
}

/// Where clips scatter most of all, other laws than `laws` show beside the scatter alone.
std::vector<WithFurther> CauseWeighing::beside_scatter_alone(const std::vector<Hypothesis>& laws) {
  const Hypothesis* alone = find(comparison(), {scatter_});
  if (alone == nullptr || !is_weighed(alone->fit)) return {};
  std::set<std::size_t> others = without_;
  for (const Hypothesis& law : laws) others.insert(law.effects.front());
  const MotionFit clips = by_noise(set_, noise_alone_[static_cast<std::size_t>(alone->fit)]);
  std::vector<WithFurther> pairs;
  for (MotionFit& both : laws_beside_scatter(set_, clips, sizes_of(*alone), others)) {
    Hypothesis law = *alone;
    law.effects = {both.effects.back()};
    pairs.push_back({std::move(law), std::move(both), clips.cost, scatter_});
  }
  return pairs;
}

/// Adds an explanation with a further cause to the comparison, in place of what it has for the same effects.
void CauseWeighing::add(WithFurther with, Settled settled) {
  excess_.of_fits.push_back(std::min(held_out_excess(set_, with.both), held_out_excess(set_, settled.noise_alone)));
  noise_alone_.push_back(std::move(settled.noise_alone));
  profiles_.push_back(std::move(settled.profile));
  allow_for_unknown_noise(set_, profiles_.front(), profiles_.back());
  const auto fit = static_cast<int>(comparison().fits.size());
  comparison().fits.push_back(linearise_again(weighed_.set, with.both));
  worth_.push_back(static_cast<std::size_t>(fit));
  Hypothesis both = std::move(with.of);
  both.effects.push_back(with.further);
  both.fit = fit;
  both.converged = with.both.converged;
  both.gain += std::max(0.0, 0.5 * (with.chi2_without - with.both.cost));
  both.log_evidence =
      is_weighed(fit) ? profiles_.back().log_evidence - evidence_of_nominal() + both.of_images : -kNotWeighed;
  std::erase_if(comparison().all, [&](const Hypothesis& one) {
    return std::set(one.effects.begin(), one.effects.end()) == std::set(both.effects.begin(), both.effects.end());
  });
  comparison().all.push_back(std::move(both));
}

/// Functions without a name alone and beside the likeliest explanations, each with a remainder of its own.
void CauseWeighing::add_functions_without_name() {
  const std::vector<Hypothesis> leaders = worth_a_function(comparison(), excess_);
  std::vector<std::vector<UnnamedFamily>> found(leaders.size());
  std::vector<std::optional<double>> logs(leaders.size());
  base::for_each_parallel(leaders.size(), jobs_, [&](std::size_t k) {
    const auto fit = static_cast<std::size_t>(leaders[k].fit);
    found[k] = fit == 0 ? comparison().unnamed : unnamed_families(ScoreSpace(weighed_.set, comparison().fits[fit]));
    logs[k] = unnamed_profile(set_, weighed_.set, profiles_.front(), noise_alone_[fit], found[k], sizes_of(leaders[k]));
  });
  for (std::size_t k = 0; k < leaders.size(); ++k) {
    if (!logs[k]) continue;
    Hypothesis both = leaders[k];
    both.unnamed = true;
    both.unnamed_log_evidence = *logs[k] - profiles_[static_cast<std::size_t>(both.fit)].log_evidence;
    both.log_evidence = *logs[k] - evidence_of_nominal() + both.of_images;
    if (both.fit > 0 && comparison().beside_fit == 0) {
      comparison().beside_fit = comparison().left_fit = both.fit;
      comparison().unnamed_left = std::move(found[k]);
    }
    comparison().all.push_back(std::move(both));
  }
}

WeighedCauses CauseWeighing::finished() {
  weighed_.fits.resize(comparison().fits.size());
  for (const std::size_t f : worth_) {
    if (std::isfinite(profiles_[f].log_evidence)) {
      weighed_.fits[f] = WeighedFit{std::move(noise_alone_[f]), profiles_[f].best.sizes};
    }
  }
  return std::move(weighed_);
}

}  // namespace

WeighedCauses weigh_causes(const TrackSet& set, const Comparison& first, const std::set<std::size_t>& without, int jobs,
                           const ImageEvidence* images, const std::function<void(double)>& done) {
  return CauseWeighing(set, first, without, jobs).run(images, done);
}

void allow_for_remainders(const TrackSet& set, const std::set<std::size_t>& without, int jobs, Comparison& comparison) {
  std::vector<Hypothesis*> worth;
  for (Hypothesis& one : comparison.all) {
    if (one.unnamed || (one.fit < 0 && !one.effects.empty())) continue;
    if (one.effects.empty() || worth.size() < kMostProfiled) worth.push_back(&one);
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
