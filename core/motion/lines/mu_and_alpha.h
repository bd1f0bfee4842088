/// mu, alpha and K/m from the lines a = a0 - (K/m) v of a configuration, one for each direction, with their
/// uncertainties. The terminal velocity: limit_velocity() of line_fit.h.
#pragma once

#include <vector>

#include "core/experiment/local_gravity.h"
#include "core/result/results.h"

namespace glidelab::core {

struct MuAndAlpha {
  Quantity mu, alpha_deg;
};

/// Friction and inclination of the two lines' intercepts (a0- of v < 0), equation (13) of the paper:
///
///     (a0- + a0+)/2 = g sin(alpha),     (a0- - a0+)/2 = mu g cos(alpha)
///
/// Where the slopes of the two lines differ by more than three standard deviations, as with clips whose friction
/// differs, the variance that mean_k() adds to each slope goes into its intercept too, along the covariance of the two.
MuAndAlpha mu_and_alpha_of_intercepts(const LineFit& minus, const LineFit& plus, const Gravity& gravity);

/// mu of one line and the stated inclination, or the reason why there is none.
Quantity mu_of_line(const LineFit& line, const Gravity& gravity, const ConfigurationResult& stated);

/// The mean of the directions' K/m, each weighted by one over its variance. If the two differ by more than three
/// standard deviations, half of the unexplained part is taken as an additional variance of each direction, with one
/// degree of freedom. (DerSimonian and Laird 1986 add it at any distance; two correct lines would then state 1.2 times
/// their standard deviation on average.) This evens out the weights, and the standard deviation grows with the spread.
Quantity mean_k(const std::vector<LineFit>& lines);

}  // namespace glidelab::core
