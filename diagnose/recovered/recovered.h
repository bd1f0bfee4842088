/// K/m, mu, alpha and the terminal velocity (limit velocity) of each configuration, with the named causes in the model.
/// K and mu are the configuration's own (own_law() of the track model).
///
/// The parameters are those at the minimum in the linear neighbourhood of the fit when the remainder counts as noise
/// (remainder.h). Their covariance is that of this model or that from the scatter of the clips' scores, whichever gives
/// the larger standard deviation:
///
///     C = H⁻¹,      C_clips = H⁻¹ (n/(n - 1) sum over clips of s s' + statements) H⁻¹
///
/// with H the information matrix, s the score of a clip, n the number of clips, and `statements` the information in
/// what the experimenter states. Other likely explanations widen it, so that intervals hold the truth even where the
/// cause is in doubt: the interval about the reported value has 95 % of the probability of all of them together, each
/// with a distribution of its own (Student's t). Where gravity is no parameter of the fit, alpha and mu contain its
/// standard deviation: the motions determine g sin(alpha) and mu g.
///
/// Where each clip has a friction and a drag of its own (clip_scatter), those of a configuration are the means of its
/// clips. With v the variance by which clips differ beyond what their fits leave open, and n the clips of the
/// configuration, v/n is added to the variance of a mean: other clips would have another one.
///
/// The terminal velocity is the speed at which the force vanishes, m g sin(alpha) = drag(v) + friction(v) with all
/// causes included, in the middle of the set-up's positions. Its standard deviation follows from the parameters'
/// covariance by finite differences. Effects that act only at some positions, times or clips (EffectLaw::passing) are
/// left out of it.
///
/// In images with one stated scale, lengths are multiplied by the mean scale along the path where a lens or a turned
/// plane makes it differ from place to place (scale_place.h).
///
/// Where the images show that the camera drifts at a speed d along the motion (TrackSet::camera_drift_m_s), every speed
/// is wrong by d, and no fit to the tracks tells it from an inclination: d is added in quadrature to the standard
/// deviation of the terminal velocity, and d |a'(v)| / (g cos(alpha)) to that of alpha, with a(v) the acceleration.
/// Tracks are not corrected, since the scene moves in the image as the marker does only at the depth of the motion.
#pragma once

#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// A fit to a set, linearised with the noise alone, the sizes of its remainder, and its probability.
struct LikelyFit {
  const MotionFit* fit = nullptr;
  RemainderSizes sizes;
  double probability = 1.0;
  std::vector<std::size_t> effects = {};  ///< of the explanation
  bool at_minimum = true;                 ///< false: the explanation's own fit stopped before it reached one
};

/// The reported explanation first.
using Explanations = std::vector<LikelyFit>;

std::vector<RecoveredConfiguration> recovered_of(const TrackSet& set, const Explanations& explanations);

}  // namespace glidelab::diagnose
