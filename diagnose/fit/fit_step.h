/// Steps of the fit of all motions that stay within the limits of its parameters.
///
/// A parameter that would leave its range stops at the edge, as does a start whose speed would leave its limit, and the
/// others take the step that is best beside it. A step that merely failed there would end the fit: no shorter one along
/// the same line descends either.
#pragma once

#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/fit_result.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

inline constexpr Eigen::Index kStartSpeed = 1;  ///< among a motion's own parameters; 0 is where it starts

/// Whether a parameter has limits that no misfit moves: effects, and of a fall gravity, the inclination and a K that is
/// held.
bool has_range(const ParameterLayout::Global& global);

/// The largest speed (m/s) at which a motion can have begun: a few times the largest mean speed between two positions,
/// noise included. Where a drag is strong and frames are few, a far faster start that is braked within a frame would
/// only move the first position.
double fastest_start(const TrackedMotion& motion);

/// Moves each parameter and start that is outside its limits to the nearest edge.
void keep_within(const TrackSet& set, const ParameterLayout& layout, FitPoint& at);

/// The parameters after one Gauss-Newton step with Levenberg-Marquardt damping, within the limits.
///
/// With J and r a motion's derivatives and residuals divided by the noise, O the own part of J, G its common part, and
/// damping l,
///
///     (N + l I) y = g,   N = sum of G'G - G'O (O'O (1 + l))^-1 O'G + statements,   g alike with r,
///
/// scaled to a unit diagonal of G'G and the statements. `fit` must have residuals and derivatives at its parameters.
FitPoint step_from(const TrackSet& set, const MotionFit& fit, double damping);

}  // namespace glidelab::diagnose
