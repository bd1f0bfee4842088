/// Limits that several searches share and that must be the same in each.
#pragma once

#include <cstddef>

namespace glidelab::diagnose {

/// Standard deviations that the largest size of an effect must make to be visible at all.
inline constexpr double kVisible_sd = 4.0;

/// Standard deviation that holds back an inclination which nobody states: as good as free.
inline constexpr double kOpenInclination_rad = 0.35;

/// Log evidence from which on something is acted upon without being weighed against anything else.
inline constexpr double kBeyondDoubt = 5.0;

/// Points from which on the shape of a scatter tells anything.
inline constexpr std::size_t kFewestScatter = 50;

/// Uneven times of filmed clips below this are none: a hundredth of a short exposure.
inline constexpr double kLeastFilmedJitter_s = 1e-5;

}  // namespace glidelab::diagnose
