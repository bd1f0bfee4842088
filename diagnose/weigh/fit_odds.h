/// The prior odds of explanations by the sizes in their fits.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// Log of the odds of a fit's sizes: -log(1 + (size/usual)²) for each parameter with a usual size (effect.h). A scale
/// or a clock that is a quarter off can stand in for a hand or for the air that moves along, a hand that pushes for
/// half a second for any force, and a lens whose axis lies at an end of the motion for a pattern off the plane; but
/// such errors are rare.
double log_odds_of_sizes(const MotionFit& fit);

/// The effects of a fit with a size at an end of the range that is searched, or with the place of a bumper or a cable
/// at an end of the positions, where it touches always or never. None is open-ended, as a bumper's stiffness is: beyond
/// some no position tells how stiff it is.
std::vector<std::size_t> effects_at_end(const MotionFit& fit);

/// The effects of a fit with a place at which they are not looked for. A bumper is short and stands in the outer
/// quarter of the positions at either end; a fit may leave these for any place, where the same force is a cable's.
std::vector<std::size_t> effects_off_search(const TrackSet& set, const MotionFit& fit);

/// Sets Comparison::fit_odds: those of the sizes, a thousandth for each effect at an end of its range or at a place at
/// which it is not looked for, and, in a fall through air, those of the drag (air_odds.h). The inertia of air that
/// moves along has a third of the odds of the drag alone that it belongs to.
void set_fit_odds(const TrackSet& set, Comparison& comparison);

}  // namespace glidelab::diagnose
