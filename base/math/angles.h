/// Degrees, which files and people use, and radians, in which everything is calculated.
#pragma once

#include <numbers>

namespace glidelab::base {

inline constexpr double kRadPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;  // each is rounded separately, so it is not 1 / the
                                                                    // other

}  // namespace glidelab::base
