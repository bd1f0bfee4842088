#include "core/track/track_data.h"

#include <cstddef>
#include <numeric>

#include "core/math/quantile.h"

namespace glidelab::core {

void take_rows_as_frames(TrackData& track) {
  track.frame.resize(track.t_s.size());
  std::iota(track.frame.begin(), track.frame.end(), std::size_t{0});
  track.frame_t_s = track.t_s;
  track.frame_rate_hz = 1.0 / median_step(track.t_s);
}

}  // namespace glidelab::core
