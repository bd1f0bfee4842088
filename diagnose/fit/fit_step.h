/// One step of Gauss and Newton, held back by Levenberg and Marquardt, towards the least squares of a motion fit.
///
/// With J and r a motion's derivatives and residuals over the noise, O its own part, G the common one, and damping l,
///
///     (N + l I) y = g,   N = sum of G'G - G'O (O'O (1 + l))^-1 O'G + statements,   g alike with r,
///
/// scaled to a unit diagonal of G'G and the statements. An effect's common parameter stays within its range: what would
/// leave it stops at the edge, and the others make the best of that.
#pragma once

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// The point that the step leads to; `fit` has residuals and derivatives where it stands.
FitPoint step_from(const MotionFit& fit, double damping);

}  // namespace glidelab::diagnose
