/// Frames that are missing right after a clip's first frames, or right before its last.
///
/// The few positions on the far side of such a gap lie off the rest, and so the analysis takes them for outliers. They
/// are none where all of them lie on the path that the others make, each by the same whole number of frames earlier
/// (the first ones) or later (the last).
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

struct EdgePosition {
  std::size_t motion = 0, point = 0;
};

/// The outliers among the first and last three positions of each motion of which a gap of one to five frames makes
/// sense: within four standard deviations of the path of `fit` that many frames away, continued by the polynomial of
/// fourth order through its nearest five points, and more than six off it where they are. Where the glider hardly moves
/// (under ten standard deviations a frame) nothing is said. No NumericalError.
std::vector<EdgePosition> positions_beyond_gaps(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
