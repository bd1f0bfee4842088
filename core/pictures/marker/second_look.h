/// A second look at a clip in which the marker was lost now and then, or does not look like a disc. The background is
/// that of other frames, and the marker is a matte sphere that is lit from one side, or a disc (lit_sphere.h).
///
/// Each frame has a window around the position of the marker, or its expected position (marker_windows.h). First, what
/// all windows share is found from up to 24 of them: the body, the tone curve of the camera, the blur of the edge, and
/// the ratio of the size of the image to that of the stated diameter. Then each frame is fitted with these fixed, the
/// lost ones outwards from their neighbours. Directions in which the background does not look as in other frames (the
/// glider, a stick, a shadow) do not count.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/marker_windows.h"
#include "core/pictures/marker/sphere/still_background.h"

namespace glidelab::core {

/// Whether a second look may improve on the first: frames without a marker between the first and the last sighting,
/// more than three such frames at either end of the clip, or residuals far above those of a disc. False for fewer than
/// eight sightings.
bool is_worth_a_second_look(const TrackedMarker& first, std::size_t frames);

/// Whether the sightings are those of one moving object: in at least half of the frames, the position lies within half
/// a radius of the one expected from the frames around. True for fewer than eight sightings.
bool is_steady(const TrackedMarker& marker);

/// The background of a clip, which is read once for it.
StillBackground background_of(const ClipAgain& clip);

/// The marker in the windows around a first look. Empty unless the sphere or disc explains the images better than the
/// fit of the first look, or in more frames. A marker that the sampled windows show to be neither takes little time.
std::optional<TrackedMarker> look_again(const TrackedMarker& first, const std::vector<FrameWindow>& windows,
                                        const StillBackground& background, const ShapeAt& shape_at);

}  // namespace glidelab::core
