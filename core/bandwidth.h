/// The default bandwidth of a clip: what its lines, and then its points, are best served by.
///
/// The kernel's bias of a is h^2 x''''/2, its noise falls with h^(-5/2). Of the pointwise best (for x'''' the same
/// everywhere h^9 = 1.058 s^2 dt / x''''^2) the lines would have too much bias: a line averages the noise of its
/// points, but not their bias, which for a = a0 - k v is (k h)^2 / 2 of both K/m and a0. So for each h of a grid of
/// ratio 1.1
///
///     E_line(h)  = sum over directions of the mean over 0 <= v <= v_max of  var + bias^2  of the fitted line,
///     E_point(h) = mean over the points that count of  var a + bias^2 a
///
/// are estimated: the variances exactly from the weights and the noise (line_fit.h), the biases by smoothing the double
/// integral of f(v(t)), f the parabola in v fitted to the points of a pilot. With h_line and h_point the minima, and
/// h_quiet the least h at which the noise of a is 1.25 % of the standard deviation of a along every line (so that noise
/// alone leaves R^2 at 0.9998, the paper's lines have 0.9996 to 1.0000),
///
///     h = max(h_line, min(h_quiet, h_point)).
///
/// That is: the line's optimum; raised, where the points would still be ragged, until they are as quiet as the paper's,
/// but never beyond the pointwise optimum. Assumes that a depends on v alone within a direction, and stationary noise.
/// The rule that the paper took from its reference [15] is not in its text; this is not claimed to be it.
#pragma once

#include <string>
#include <vector>

#include "core/free_motion.h"
#include "core/motion.h"
#include "core/noise.h"

namespace glidelab::core {

struct BandwidthChoice {
  double bandwidth_s = 0.0;
  std::string method;  ///< one line for a reader
  double line_s = 0.0, point_s = 0.0, quiet_s = 0.0;
};

/// f(v) at every point of the stretches (0 elsewhere): per direction a line in v, a parabola where that is
/// significantly better (F above 9), a constant where v hardly varies, through the points smoothed at `bandwidth_s`.
/// The fit averages the noise of its points, so half the pilot's bandwidth, with a quarter of its bias, serves
/// (law_bandwidth).
std::vector<double> pilot_law(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s);

double law_bandwidth(const Motion& motion, double pilot_bandwidth_s);

/// Where no bandwidth gives a line the pilot's is taken, and the method says so.
BandwidthChoice choose_bandwidth(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                 const PositionNoise& noise, double pilot_bandwidth_s);

}  // namespace glidelab::core
