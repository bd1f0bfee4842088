/// Why what is followed in a clip is not the marker.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/analysis/seen_clip.h"
#include "core/experiment/experiment.h"
#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/pattern/moving_pattern.h"

namespace glidelab::core {

/// Why a track is not that of the object at start_px: in the frame to which start_px refers it is elsewhere or, beyond
/// its ends, neither is it on its way from there nor has it been at rest there. Empty if it may be that object, and if
/// no start_px is given.
std::optional<NoMarker> not_from_start(const SeenClip& seen, const MarkerSetup& marker, const ClipSetup& clip);

/// Why the track of a clip is not that of the marker although something is followed in it: it is ten times rougher than
/// the median of the others, and by more than 0.3 px. Empty if it is not, and for fewer than two others.
std::optional<NoMarker> far_rougher(const std::vector<SeenClip>& clips, std::size_t which, const ClipSetup& clip);

/// Throws TwoMarkers if another pattern looks and moves like the one at `which`.
void require_no_twin(const std::vector<MovingPattern>& patterns, std::size_t which, const ClipSetup& clip);

}  // namespace glidelab::core
