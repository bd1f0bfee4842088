/// A second look at a clip in which the marker was lost now and then, or does not look like a disc: its images against
/// the background that other frames show, and the marker as a matte sphere that is lit from one side (lit_sphere.h).
///
/// The clip is read once more and a window kept around the place where the marker is or should be in each frame. What
/// all windows share is found first, from some of them: the camera's tone curve, the edge's blur, the size of the image
/// over the one that the stated diameter gives. Then each frame is fitted with these held, the lost ones from their
/// neighbours outwards. Directions in which the background does not look as in the other frames (the glider, a stick, a
/// shadow) do not count.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker_body.h"
#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/still_background.h"

namespace glidelab::core {

/// The elements uu, uv, vv of M (1/px): the outline of the marker that is seen at a pixel is |M d| = 1.
using ShapeAt = std::function<std::optional<cv::Vec3d>(cv::Point2d, MarkerBody)>;

/// A clip that can be read again.
struct ClipAgain {
  std::function<std::unique_ptr<FrameSource>()> open;
  std::size_t frames = 0;
};

/// Whether the first look leaves something to be wished for: frames without a marker between the first and the last, or
/// at the clip's ends, or residuals far above what a disc leaves.
bool is_worth_a_second_look(const TrackedMarker& first, std::size_t frames);

/// Whether the sightings are those of one thing that moves: in at least half of the frames a place lies within half a
/// radius of what the frames around it say. Fewer than eight sightings say nothing against it.
bool is_steady(const TrackedMarker& marker);

/// The background of the clip.
StillBackground background_of(const ClipAgain& clip);

/// The marker in the clip, where the sphere explains the images better than what the first look fitted, or in more
/// frames; nothing elsewhere.
std::optional<TrackedMarker> look_again(const TrackedMarker& first, const ClipAgain& clip,
                                        const StillBackground& background, const ShapeAt& shape_at);

}  // namespace glidelab::core
