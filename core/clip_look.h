/// The pictures of a clip whose marker has been found: how they are exposed, how the marker stands out, what the file
/// says.
///
/// The clip is read again from its start to its end.
#pragma once

#include <optional>
#include <vector>

#include "core/experiment.h"
#include "core/exposure_watch.h"
#include "core/frame_source.h"
#include "core/results.h"

namespace glidelab::core {

struct ClipLook {
  cv::Size size;
  Exposure exposure;
  FileFacts file;
  /// Of the marker where it was seen, by the fit of core/marker.h in some of those frames, as shares of the largest
  /// code; no contrast for a marker that is known by its hue, and a level for a bright one only.
  std::optional<double> contrast;
  std::optional<double> marker_level;
  double pixel_noise = 0.0;  ///< of pixels away from the marker, from one frame to the next; 0 where none is seen
};

/// InputError where the clip cannot be read.
ClipLook look_at_clip(const Experiment& experiment, const ClipSetup& clip, const std::vector<MarkerSighting>& sightings,
                      const FrameOpener& open = open_frames);

}  // namespace glidelab::core
