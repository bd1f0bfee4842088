/// K/m, mu, alpha and the terminal velocity of each configuration, with the named causes in the model.
///
/// The parameters are those at the minimum of the fit's neighbourhood when the remainder counts as noise (remainder.h).
/// Their standard deviation is that of this model, or that from the scatter of the clips' scores, whichever is larger:
///
///     C = H⁻¹,      C_clips = H⁻¹ (n/(n - 1) sum over clips of s s' + statements) H⁻¹
///
/// Explanations that are nearly as likely as the reported one widen it, sd² = sum of p (sd² + (value - reported)²) /
/// sum of p, so that intervals hold the truth also where the cause is in doubt. The terminal velocity is where the
/// force vanishes, m g sin(alpha) = drag(v) + friction(v) with all causes in it, in the middle of the set-up's track;
/// its standard deviation follows from the parameters' covariance by finite differences. Causes that act only for a
/// while (a hand, a shaking) are left out of it.
#pragma once

#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// A fit to a set, linearised by the noise alone, the sizes of its remainder, and how likely it is.
struct LikelyFit {
  const MotionFit* fit = nullptr;
  RemainderSizes sizes;
  double probability = 1.0;
  std::vector<std::size_t> effects = {};  ///< that it holds
};

/// The reported one first.
using Explanations = std::vector<LikelyFit>;

std::vector<RecoveredConfiguration> recovered_of(const TrackSet& set, const Explanations& explanations);

}  // namespace glidelab::diagnose
