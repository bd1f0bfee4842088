/// The evidence of one explanation beside its own remainder: the unmodelled random acceleration and scatter
/// (remainder.h) of the sizes that make the positions likeliest, and the fit at the minimum under that remainder.
#pragma once

#include <limits>

#include "diagnose/causes/remainder.h"
#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

struct Profile {
  RemainderSpace::Best best;
  double chi2 = 0.0;
  double log_evidence = -std::numeric_limits<double>::infinity();  ///< also if the fit has failed
};

/// `noise_alone` is linearised with the noise alone. The search for the sizes begins at `start`, if there is one.
/// `extra` are functions without a name beside the fit.
Profile profile_of(const TrackSet& set, const MotionFit& noise_alone, const RemainderSizes* start,
                   const RemainderExtra* extra = nullptr);

/// A fit and its remainder.
struct Settled {
  MotionFit noise_alone;
  Profile profile;
};

/// An explanation at the minimum under its own remainder. The likelihood of a remainder is that of the linear
/// neighbourhood of a fit. A fit by the noise alone, or by the remainder of another explanation, may lie so far from
/// the minimum that the linear model promises what the motion cannot do, or hides what it can: the evidence of two
/// explanations would then differ by where their fits happen to stand.
Settled settled(const TrackSet& set, const MotionFit& from, const RemainderSizes& start);

/// Takes off what a gain over the nominal model's chi² is worth less where few positions show the noise.
void allow_for_unknown_noise(const TrackSet& set, const Profile& nominal, Profile& profile);

}  // namespace glidelab::diagnose
