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
#pragma once

#include "diagnose/fit/fit_model.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// The start in the layout without effects. SI units.
FitPoint integrated_start(const TrackSet& set);

}  // namespace glidelab::diagnose
