/// Which way a body falls, where nobody states the sign of x.
///
/// A fall is downwards, whether its sensor is above or below. The direction is that of the displacement if the body
/// hardly turns, and otherwise that of the acceleration between both ends and the middle of the time. A body that is
/// thrown upwards may land above its start, or not at all: if a parabola describes the positions (rms residual at most
/// 3 % of their range) with an acceleration of 0.7 g or more, that acceleration points down. Drag makes it larger on
/// the way up, and one of a fall towards its terminal velocity is below g.
#pragma once

#include <vector>

#include "core/track/track_data.h"

namespace glidelab::core {

/// How far the body falls, in m; negative if x decreases on the way down. Of speeds, which way they point, in m/s.
double signed_drop(const TrackData& track);

/// Reverses x (and the force) of all tracks if the sum of their drops is negative, with a note in each. The tracks are
/// of one set-up, so that one sign holds for all.
void count_downwards(const std::vector<TrackData*>& tracks);

}  // namespace glidelab::core
