/// Tracks a marker that is neither a disc nor a sphere (a ring, a bull's eye, quadrants, a sphere in front of the
/// glider with its shadow on it) by its own look (marker_template.h). It starts from a rough track of something of
/// about that size.
#pragma once

#include <optional>

#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/second_look.h"

namespace glidelab::core {

/// Reads the clip once more, and finds the look and the positions in all frames in turns. Frames in which the marker
/// was lost follow from their neighbours outwards. Empty if the look or the path is not steady, or if the marker is
/// seen in fewer frames than before.
std::optional<TrackedMarker> look_by_template(const TrackedMarker& rough, const ClipAgain& clip,
                                              const ShapeAt& shape_at);

}  // namespace glidelab::core
