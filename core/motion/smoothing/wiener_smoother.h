/// The Kalman smoother and the smoothing spline: one posterior (wiener_chain.h) with two ways to choose its strength.
///
/// Both smooth all parts of a motion with one strength, by a process of order N = 4 (x, v, a and the jerk; a spline of
/// degree 7). With s the noise of a position and dt the mean step, the strength is tau = (s^2 dt / q)^(1/2N): x is
/// followed up to the angular frequency 1/tau.
///
///  kalman: tau, and the standard deviation j of the jumps of a, maximise the marginal likelihood, with what is not
///     known at a part's start integrated out and a flat prior of sqrt(q) (Gelman 2006, Bayesian Anal. 1, 515); s
///     where it is not stated as well, in closed form. Standard deviations are averaged over tau by its likelihood,
///     for a few effective parameters do not determine it.
///  spline: tau makes  n sum ((y - x)/f)^2 / (n - trace)^2  least (generalised cross-validation, Craven and Wahba 1979,
///     Numer. Math. 31, 377), a may jump by anything at a break, s^2 = sum ((y - x)/f)^2 / (n - trace).
///
/// tau is looked for on a grid of ratio 1.5, from 0.3 steps to three times the longest part, and then by Brent's
/// method. Breaks lie where the smoothed v is 0: found again with each smoothing, until they stay.
#pragma once

#include "core/motion/smoothing/smoother.h"

namespace glidelab::core {

const Smoother& kalman_smoother();
const Smoother& spline_smoother();

}  // namespace glidelab::core
