/// Where a fit of the nominal model starts: its parameters from the positions alone, by the equation of motion
/// integrated twice.
///
///     x(t) = x0 + v0 t + sin(alpha) g t²/2 - mu g cos(alpha) int int sign(v) - K/m int (x - x0) + int int F/m
///
/// is linear in K, mu, sin(alpha), x0 and v0 once the x under the integral is the measured one and sign(v) changes at
/// the turns that the positions show. Nothing is differentiated, so noise hardly matters. There is a single minimum,
/// however long the motion and however far the stated inclination is from the true one. Errors are of the order of the
/// noise over the range of x; misfit of the nominal model enters as in any least-squares fit.
///
/// Friction and drag are never negative here: a fit should not start with a glider that they drive. If the positions
/// leave a direction undetermined (mu and the inclination if motions go one way), the statements and wide priors
/// decide.
///
/// A force -k (x - x_b) beyond some place x_b, as a bumper or a cable exerts, is linear in k in the same way for each
/// x_b. The nominal model follows no bounce, so nothing in its neighbourhood says where x_b is.
#pragma once

#include <optional>

#include "diagnose/fit/fit_model.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// The start in the layout without effects. SI units.
FitPoint integrated_start(const TrackSet& set);

/// Whether an effect is such a force, with a size and a place beyond which it acts.
bool has_integrated_start(std::size_t effect);

/// The start with such an effect, in the layout with it alone. Empty for others, and if the positions show no such
/// force.
std::optional<FitPoint> integrated_start(const TrackSet& set, std::size_t effect);

}  // namespace glidelab::diagnose
