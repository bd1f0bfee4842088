/// A clip's marker by its own look (marker_template.h), where it is neither a disc nor a sphere: a ring, a bull's eye,
/// quadrants, a sphere before the glider with its own shadow. Something of about its size was followed before, if only
/// roughly.
#pragma once

#include <optional>

#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/second_look.h"

namespace glidelab::core {

/// The clip is read once more. The look and the places in all frames are found in turns, those of frames in which it
/// was lost from their neighbours outwards. Nothing where what is found is no steady look on a steady path, or is seen
/// in fewer frames than before.
std::optional<TrackedMarker> look_by_template(const TrackedMarker& rough, const ClipAgain& clip,
                                              const ShapeAt& shape_at);

}  // namespace glidelab::core
