/// mu, alpha and K/m from the lines a = a0 - (K/m) v of a configuration, one for each direction, with their
/// uncertainties; what motion in one direction and a stated inclination tell together; and which value of gravity that
/// rests on. The terminal velocity: limit_velocity() of line_fit.h.
#pragma once

#include <optional>
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

/// mu of motion in one direction, v > 0 (s = 1) or v < 0 (s = -1), and a stated inclination, with its derivatives:
///
///     a0 = g (sin(alpha) - s mu cos(alpha)),     mu = s (tan(alpha) - a0 / (g cos(alpha)))
///
/// Motion in both directions gives alpha itself; its stated value is then not used.
struct MuOfOneDirection {
  double value = 0.0;
  double by_a0 = 0.0;
  double of_incline = 0.0;  ///< change for one standard deviation of the stated inclination
  double by_gravity = 0.0;
};

/// Empty if the configuration states no uncertainty of its inclination, or if 90 degrees, where there is no normal
/// force, are within five standard deviations.
std::optional<MuOfOneDirection> mu_of_one_direction(const ConfigurationResult& stated, int direction, double a0_m_s2,
                                                    double gravity_m_s2);

/// mu of one line and the stated inclination, or the reason why there is none.
Quantity mu_of_line(const LineFit& line, const Gravity& gravity, const ConfigurationResult& stated);

/// Whether the inclination with its uncertainty would give mu, and is not stated.
bool incline_would_do(const ConfigurationResult& configuration);

/// The mean of the directions' K/m, each weighted by one over its variance. If the two differ by more than three
/// standard deviations, half of the unexplained part is taken as an additional variance of each direction, with one
/// degree of freedom. (DerSimonian and Laird 1986 add it at any distance; two correct lines would then state 1.2 times
/// their standard deviation on average.) This evens out the weights, and the standard deviation grows with the spread.
Quantity mean_k(const std::vector<LineFit>& lines);

/// Notes the inclination on which mu rests: that of motion in one direction. Replaces an earlier note.
void note_mu_from_incline(ConfigurationResult& configuration);

/// Notes in the first configuration that has alpha or mu that their value of gravity is assumed. Replaces an earlier
/// note.
void note_gravity(AnalysisResults& results);

}  // namespace glidelab::core
