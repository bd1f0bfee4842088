/// One clip of a recording as its track and its pictures show it: speeds, the marker's size and smear, light, steps
/// that came out too short.
#pragma once

#include <string>
#include <vector>

#include "core/check/recording_check.h"
#include "core/experiment/experiment.h"
#include "core/pictures/marker/marker.h"
#include "core/pictures/scene/clip_look.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// One track with the fits behind it, or why there is none.
struct ClipAttempt {
  TrackData track;
  std::vector<MarkerFit> fits;
  std::string failure;
};

/// What can be said of the clip alone; `watches` have seen its pictures, where it has any and they could be tracked.
ClipCheck check_clip(const Experiment& experiment, const ClipSetup& setup, const ClipAttempt& attempt,
                     const ClipWatches& watches);

}  // namespace glidelab::core
