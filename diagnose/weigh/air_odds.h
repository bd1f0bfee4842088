/// The prior odds of explanations of a fall through air that have no quadratic drag.
///
/// At the speeds of such a fall the drag of air is not viscous (falls_through_air()), so that an explanation in which
/// braking shows and is viscous has the odds of one in twenty, a judgement: a liquid, a magnet in a copper pipe, or
/// made data, as one of ten falls from other people's repositories was. Of positions that do not tell, the quadratic
/// drag is then likely, not certain. An explanation without any drag is as likely as it was. With K = z standard
/// deviations off 0, a fall without drag is likelier than one with a viscous drag of any size (uniform in its logarithm
/// over four decades, 9.2 = ln 10^4) by the factor
///
///     B = 9.2 max(|z|, 2)/sqrt(2 pi) exp(-z²/2),     odds = 0.05 + B, or 0.001 + B for a K below 0, which drives.
///
/// Effects that change the viscous drag need one, and air moves along only with what it brakes: both have its odds. An
/// inertia that is too large for air (by two standard deviations) is that of a pulley or a wheel, and asks for no drag.
/// The air that moves with a disc of radius r, broadside on, weighs
///
///     8/3 rho r³ = 11 g     for r = 0.15 m and rho = 1.2 kg/m³.
///
/// or, where no mass is stated, ten times the mass (fit/drag_of_air.h). An inertia above
/// that by less than two standard deviations is neither, and has odds of 0.001. Where drag bears half of the weight or
/// more, nothing but air moves along: inertia slows a wheel, not drag, and a body that is seen at its terminal velocity
/// allows any inertia.
///
/// Such an inertia beside a quadratic drag is a second cause (odds of 1/20), not the air of that drag.
///
/// In an explanation with a quadratic drag, that drag takes the place of K (fit/drag_of_air.h). Explanations with
/// either drag then have the same kind of prior for its size.
#pragma once

#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// Log of these odds for the model of a fit; 0 for one with a quadratic drag or a power law of the drag and
/// no wheel, and where nothing falls through air.
double log_odds_without_air(const TrackSet& set, const MotionFit& fit);

/// Whether the quadratic drag alone asks for more than air can do to a square metre: 0.6 kg/m, half the density of air
/// times the area. Then a liquid or a magnet brakes. Without a stated mass the drag in kg/m is not known, and nothing
/// tells.
bool too_strong_for_air(const TrackSet& set, const Comparison& comparison);

}  // namespace glidelab::diagnose
