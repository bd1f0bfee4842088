/// What a video file says of its times, and frames that came twice.
#pragma once

#include <cstddef>
#include <optional>

#include "core/frame_source.h"

namespace glidelab::core {

struct FrameTimes {
  std::optional<double> container_rate_hz;
  std::size_t irregular_steps = 0;  ///< between time stamps, that differ from the median step
  std::size_t repeated = 0;         ///< frames equal to the one before, bit by bit
  double drift_frames = 0.0;        ///< how far the stamps leave a uniform row, in frames
};

/// Of a source that has been read to its end; of a folder of frames, and of frames from elsewhere, nothing is known.
FrameTimes times_of(const FrameSource& source);

}  // namespace glidelab::core
