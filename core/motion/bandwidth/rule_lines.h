/// The default bandwidth of a clip: chosen first for its lines, then for its points.
///
/// The kernel's bias of a is h^2 x''''/2, its noise falls with h^(-5/2). The pointwise optimum (for constant x'''', h^9
/// = 1.058 s^2 dt / x''''^2) would give the lines too much bias: a line averages the noise of its points, but not their
/// bias, which for a = a0 - k v is (k h)^2 / 2 of both K/m and a0. A wide kernel also costs the points near every end
/// and reversal. So for each h of a grid of ratio 1.1, from 1.2 time steps on,
///
///     E(h) = sum over directions of the mean over 0 <= v <= v_max of  variance + bias^2  of the fitted line
///
/// is estimated: the variance exactly from the weights and the noise (line_fit.h), the bias by smoothing the double
/// integral of f(v(t)), f the law fitted to the points of a first smoothing; it is taken to be no less than at any
/// smaller h, because v(t) is noisy and the bias could vanish somewhere by chance. The h of smallest E is the optimum
/// for the lines.
///
/// At low noise that h leaves the points rougher than necessary. It is then raised until the noise of a is 1.25 % of
/// the standard deviation of a along every line that is not level (noise alone then leaves R^2 at 0.9998; the paper's
/// lines have 0.9996 to 1.0000), but only while the bias of every line stays below 0.35 % of its size and the lines'
/// variance below 1.25 times that at the smallest E.
///
/// Assumes a law that is roughly a line within a direction, and stationary noise. The paper took its rule from its
/// reference [15] and does not state it; this rule is not claimed to be it.
#pragma once

#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/smoothing/noise.h"
#include "core/result/strength.h"

namespace glidelab::core {

struct BandwidthChoice {
  double bandwidth_s = 0.0;
  StrengthChoice method;
};

/// f(v(t)) at every point of the stretches (0 elsewhere): f is the line of each direction, v(t) is smoothed at
/// `bandwidth_s`. The fit averages the noise of its points, so half the pilot's bandwidth, with a quarter of its bias,
/// serves (law_bandwidth). A law that is not a line gets the bias that its mean slope gives for the true v(t). The
/// slope is corrected for its noise, so it is 0 only if it is not distinguishable from 0: a glider near its terminal
/// velocity has a slope like any other, however little v changes.
std::vector<double> pilot_law(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s);

double law_bandwidth(const Motion& motion, double pilot_bandwidth_s);

/// If no bandwidth gives a line, the pilot's is used (chosen_by::FirstSmoothing).
BandwidthChoice choose_bandwidth(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                 const PositionNoise& noise, double pilot_bandwidth_s);

}  // namespace glidelab::core
