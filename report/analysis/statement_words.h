/// A statement that the motion contradicts, as sentences: an inclination, or a fall.
#pragma once

#include <string>

#include "core/result/results.h"

namespace glidelab::report {

/// "the acceleration gives an inclination of 0.42 ± 0.13°, but incline_deg says 4.30 ± 0.30°"
std::string contradiction_words(const core::InclineContradiction& contradiction);
/// What may be wrong then: "x seems to be positive uphill, and …", "an angle, a length, … is wrong".
std::string contradiction_causes(const core::InclineContradiction& contradiction);

/// "the line of this fall begins with 0.700 ± 0.011 m/s² at v = 0, far below gravity. …", with what may be the reason.
std::string slow_fall_words(const core::SlowFall& fall);

}  // namespace glidelab::report
