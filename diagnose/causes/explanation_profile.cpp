#include "diagnose/causes/explanation_profile.h"

#include <cmath>
#include <utility>

#include "diagnose/causes/parameter_prior.h"
#include "diagnose/weigh/unknown_noise.h"

namespace glidelab::diagnose {
namespace {

constexpr int kMostSettling = 3;          // fits of an explanation beside its own remainder
constexpr double kSettledEvidence = 0.5;  // log evidence: a smaller change decides nothing

}  // namespace

Profile profile_of(const TrackSet& set, const MotionFit& noise_alone, const RemainderSizes* start,
                   const RemainderExtra* extra) {
  Profile profile;
  if (!std::isfinite(noise_alone.cost)) return profile;
  const RemainderSpace space(set, noise_alone, extra);
  profile.best = space.likeliest(start);
  profile.chi2 = space.chi2(profile.best.sizes);
  profile.log_evidence = profile.best.log_likelihood + log_prior(set, noise_alone, space.solve(profile.best.sizes));
  return profile;
}

Settled settled(const TrackSet& set, const MotionFit& from, const RemainderSizes& start) {
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

void allow_for_unknown_noise(const TrackSet& set, const Profile& nominal, Profile& profile) {
  const double gain = 0.5 * (nominal.chi2 - profile.chi2);
  profile.log_evidence -= lost_to_unknown_noise(few_positions(set), nominal.chi2, gain);
}

}  // namespace glidelab::diagnose
