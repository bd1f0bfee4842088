/// Which of the paths through a clip is the marker, and in which of its frames it is seen undisturbed.
///
/// The marker is the path nearest to start_px in the first frames where that is given; else, of those that move, the
/// one that is most like a marker in size, travel, brightness and number of sightings; else the only one of the right
/// size that rests all the time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/errors.h"
#include "core/experiment/experiment.h"
#include "core/pictures/marker/marker.h"
#include "core/pictures/marker/marker_path.h"
#include "core/result/results.h"

namespace glidelab::core {

/// Nothing in the clip is like the marker.
class NoMarker : public base::InputError {
  using base::InputError::InputError;
};

struct TrackedMarker {
  std::vector<MarkerSighting> sightings;  ///< frames rise
  std::vector<MarkerFit> fits;            ///< of each sighting
  std::vector<std::string> notes;
};

/// What was followed through a clip.
struct FollowedPaths {
  std::vector<MarkerPath> paths;  ///< joined, each with a method
  std::size_t frames = 0;         ///< of the clip
  double radius_px = 0.0;         ///< that the marker should have in the middle of the image
};

/// NoMarker and InputError as MarkerTracker::finish(); `clip` is the file that they name.
TrackedMarker choose_marker(const FollowedPaths& followed, const MarkerSetup& marker,
                            const std::filesystem::path& clip);

}  // namespace glidelab::core
