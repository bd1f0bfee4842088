/// Where the free part of a recorded fall begins and ends: when the body is let go, and when it lands.
#pragma once

#include <cstddef>

#include "core/motion/free/motion.h"

namespace glidelab::core {

inline constexpr std::size_t kFewestBlockPoints = 8;  ///< of a fall, or of any block that is fitted (free_motion.h)

/// The first point of a recorded fall at which the body falls freely; 0 if it does so from the first point on.
///
/// A body that is held before t_r and falls from rest then, against a drag that grows with v or with v^2, moves by
///
///     s(u) = a (exp(-w u) - 1 + w u)/w^2    or    s(u) = a ln cosh(w u)/w^2,    u = max(0, t - t_r)
///
/// with the terminal velocity a/w. If it has been released (or thrown down) before the first point, the same laws hold
/// with t_r before it. Both are fitted to all points before `to`; the body counts as held where the best t_r after the
/// first point has a chi² that is smaller by 25 than the best one before it, with the noise of the points or their
/// scatter about the better fit where that is larger. That scatter may be twice the noise at most, and a hand that
/// opens within 2 to 16 steps, and 0.4 of the rest of the fall, may not fit better by 2: a hand that lowers the body,
/// or lets it go slowly, is left to the diagnosis. Nothing is cut if fewer than kFewestBlockPoints would be left.
/// `direction`: the sign of v.
std::size_t released_at(const Motion& motion, int direction, std::size_t to);

/// The first point of a recorded fall that is no longer free, because the body has landed; the number of points if it
/// has not. Free fall does not slow down before it lands: all steps behind the landing are slower than 0.7 of the
/// largest speed (the median of three steps), and together fall short of it by more than five standard deviations. A
/// body that bounces, or goes on at a lower speed for more than five positions, has not come to lie there.
/// `direction`: the sign of v.
std::size_t landed_from(const Motion& motion, int direction);

}  // namespace glidelab::core
