/// What counts as a jump of a recorded path: a body does not jump, so that positions behind one are not its own
/// (unseen_positions.h, false_positions.h).
#pragma once

#include <cstddef>

namespace glidelab::core {

inline constexpr std::size_t kFewestSteps = 8;    ///< that show the speed of the motion
inline constexpr std::size_t kNearestOfJump = 6;  ///< steps, or positions, on one side of a jump
inline constexpr double kTypicalOfSteps = 0.9;    ///< quantile of the speeds of all steps
inline constexpr double kJump = 4.0;              ///< times the speed: a launch or a stop within one step has 1

}  // namespace glidelab::core
