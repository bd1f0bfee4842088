/// The Kalman smoother and the smoothing spline: one posterior (wiener_chain.h) with two ways to choose its strength.
///
/// Both smooth all parts of a motion by one process: of order N = 3, 4 or 5, whose last derivative decays at a rate k,
/// or not at all. Without noise it is a polynomial of degree N - 1, or one of degree N - 2 and an exponential: motion
/// under constant and viscous friction is exactly that, with N = 3. With s the noise of a position and dt the mean
/// step, the strength is tau = (s^2 dt / q)^(1/2N): x is followed up to the angular frequency 1/tau.
///
///  kalman: N, k, tau and the standard deviation j of the jumps of a are the most probable ones by the marginal
///     likelihood (smoothness_search.h), with the unknowns at a part's start integrated out; so is s, in closed form,
///     if it is not stated.
///  spline: N and tau make  n sum ((y - x)/f)^2 / (n - 1.4 trace)^2  least (generalised cross-validation, Craven and
///     Wahba 1979, Numer. Math. 31, 377; 1.4: Kim and Gu 2004, J. R. Stat. Soc. B 66, 337), k is the most likely one, a
///     has a free jump at a break, s^2 = sum ((y - x)/f)^2 / (n - trace). The motion of N = 3 without noise stands
///     unless the least is below its value by more than a factor n^(1/n) (as by Schwarz 1978, Ann. Stat. 6, 461):
///     by cross-validation alone one clip in fifty gets a needless order, with 8 times the error of a.
///
/// Standard deviations of both are those of the curve's error over all N, k and tau that the positions leave possible
/// (smoothing_ensemble.h). Breaks lie where the smoothed v is 0; they are found again with each smoothing, until they
/// stay.
#pragma once

#include "core/motion/smoothing/smoother.h"

namespace glidelab::core {

const Smoother& kalman_smoother();
const Smoother& spline_smoother();

/// The rows of all points by the integrated Wiener process of order 4 alone, with its most likely strength: no rate, no
/// exact motion and no mixture, so that they contain nothing of a law of motion. For effects that must be found
/// independently of any law.
std::vector<std::optional<KernelRow>> lawless_rows(const SmoothingInput& input);

}  // namespace glidelab::core
