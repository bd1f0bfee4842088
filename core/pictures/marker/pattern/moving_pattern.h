/// Finds patterns that are the same after half a turn (a ring, a bull's eye, a disc of several colours) and move,
/// whatever they are fixed to. A plate that stands out more than the pattern on it leads a search for spots astray; the
/// pattern's own pixels, matched from frame to frame, do not mind.
#pragma once

#include <opencv2/core.hpp>

#include <vector>

#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/marker_windows.h"

namespace glidelab::core {

/// A pattern that moved, with its places to about a twentieth of a pixel.
struct MovingPattern {
  TrackedMarker rough;
  cv::Mat look;  ///< CV_32F: the pixels around its centre, where it was found first
};

/// Compares the surroundings of every pixel with themselves after half a turn, at regular intervals through the clip,
/// and follows those of them that are alike, and that no shift leaves alike (an edge would slide along itself), by the
/// correlation of their pixels. Those that move by less than least_travel() are no result. Of those that are seen in
/// about as many frames as the longest, the one most like itself after half a turn comes first.
std::vector<MovingPattern> moving_patterns(const ClipAgain& clip, const RadiusAt& radius_at);

/// Whether they look alike, move as far, and are seen side by side in half of the frames of the shorter one.
bool are_twins(const MovingPattern& one, const MovingPattern& other);

}  // namespace glidelab::core
