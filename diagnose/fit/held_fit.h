/// A fit in which some common parameters stay as they start.
///
/// What a cause takes of a gap is measured with the shape that was found with all causes together: where a cable
/// tightens, until when a hand pushes. Such a parameter is held by a statement with a ten-millionth of its range.
#pragma once

#include <vector>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// fit_motions(), with the common parameters of these indices held at `start`.
MotionFit fit_held(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& start,
                   const Lateness& late, const std::vector<std::size_t>& held);

}  // namespace glidelab::diagnose
