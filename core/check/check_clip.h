/// The measurements of one clip, from its track and its images: speeds, size and smear of the marker, light, steps that
/// are too short.
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

/// `watches` have seen the clip's images if it has any and they could be tracked.
ClipCheck check_clip(const Experiment& experiment, const ClipSetup& setup, const ClipAttempt& attempt,
                     const ClipWatches& watches);

}  // namespace glidelab::core
