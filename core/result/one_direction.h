/// What motion in one direction and a stated inclination tell together, and which value of gravity that rests on.
///
///     v > 0 (s = 1), v < 0 (s = -1):   a0 = g (sin(alpha) - s mu cos(alpha))
///                                      mu = s (tan(alpha) - a0 / (g cos(alpha)))
///
/// Motion in both directions gives alpha itself; its stated value is then not used.
#pragma once

#include <optional>

#include "core/result/results.h"

namespace glidelab::core {

/// mu with its derivatives.
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

/// Whether the inclination with its uncertainty would give mu, and is not stated.
bool incline_would_do(const ConfigurationResult& configuration);

/// Notes the inclination on which mu rests: that of motion in one direction. Replaces an earlier note.
void note_mu_from_incline(ConfigurationResult& configuration);

/// Notes in the first configuration that has alpha or mu that their value of gravity is assumed. Replaces an earlier
/// note.
void note_gravity(AnalysisResults& results);

}  // namespace glidelab::core
