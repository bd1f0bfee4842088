/// Windows of a clip around the positions of a marker, for fits that go over the pixels more than once: the clip is
/// read once for all of them.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker_body.h"
#include "core/pictures/marker/marker_path.h"

namespace glidelab::core {

/// The elements uu, uv, vv of M (1/px): |M d| = 1 is the outline of a marker that is seen at a pixel. Empty if the
/// camera cannot see one there.
using ShapeAt = std::function<std::optional<cv::Vec3d>(cv::Point2d, MarkerBody)>;

/// A clip that can be read once more.
struct ClipAgain {
  std::function<std::unique_ptr<FrameSource>()> open;
  std::size_t frames = 0;
};

struct FrameWindow {
  std::size_t frame = 0;
  cv::Mat codes;         ///< CV_32F
  cv::Rect part;         ///< of the image
  cv::Point2d expected;  ///< where the marker is or, in a frame without it, where its neighbours expect it
  bool seen = false;     ///< whether the marker was seen in the frame
  double full_code = 255.0;
};

/// Three radii and 6 px to every side of a marker that was seen, six radii and 6 px of one that was not. Frames more
/// than thirty away from any sighting have none.
std::vector<FrameWindow> windows_around(const TrackedMarker& marker, const ClipAgain& clip, const ShapeAt& shape_at);

}  // namespace glidelab::core
