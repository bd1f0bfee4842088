/// Which way a motion goes at every point, where it turns and where it rests.
#pragma once

#include <vector>

#include "core/motion/free/motion.h"
#include "core/motion/free/pilot.h"

namespace glidelab::core {

struct MotionRuns {
  std::vector<int> direction;        ///< of every point: the sign of v, 0 at rest
  std::vector<double> turns_s;       ///< times at which v changes its sign
  std::vector<double> rest_edges_s;  ///< times at which a rest begins or ends
};

/// Direction: the sign of v where |v| is significant (still_below) and the run of equal signs covers at least twenty
/// standard deviations of a position; in less, the noise leaves an acceleration uncertain by a fifth and more.
///
/// Between two runs lies a rest, where x has next to no slope and curvature for three pilot bandwidths; it is grown
/// while x stays within three standard deviations of its median, so that what borders on it is truly moving. Otherwise
/// it is a reversal (or a slow passage), split where the smoothed x is extreme.
MotionRuns find_runs(const Motion& motion, const Pilot& pilot);

}  // namespace glidelab::core
