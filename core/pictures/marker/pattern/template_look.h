/// Tracks a marker that is neither a disc nor a sphere (a ring, a bull's eye, quadrants, a sphere in front of the
/// glider with its shadow on it) by its own appearance (marker_template.h). It starts from a rough track of an object
/// of about that size.
#pragma once

#include <optional>
#include <vector>

#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/marker_windows.h"

namespace glidelab::core {

/// What is known of a rough track.
enum class RoughTrack {
  of_parts,   ///< it may lie on any part of the object
  of_outline  ///< it is that of the centre of an outline of the stated size (framed_square.h), which the look keeps
};

/// Finds the look and the positions in all windows around a rough track alternately, eight times. Frames in which the
/// marker was lost are fitted outwards from their neighbours. If the guesses lie on different parts of the object in
/// different frames, their common look is none of it: the look of a short stretch then spreads to the other frames, and
/// counts if it has a centre of its own. Frames that the camera lost are steps of the path (skipped_frames.h). Empty if
/// the residuals or the roughness of the path are too large, if the path lies on a lattice of whole pixels although the
/// object moves, if the look has no edge at the expected outline, or if the marker is seen in fewer frames than before
/// (or in fewer than eight). A track of an outline has its centre already: neither short stretches nor the look's own
/// centre are tried, and no edge is looked for.
std::optional<TrackedMarker> look_by_template(const TrackedMarker& rough, const std::vector<FrameWindow>& windows,
                                              const ShapeAt& shape_at, RoughTrack kind = RoughTrack::of_parts);

}  // namespace glidelab::core
