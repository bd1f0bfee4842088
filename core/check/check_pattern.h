/// The pictures of the pattern, looked at before any analysis: in which it is seen, how well one camera explains them,
/// how much of the picture they cover.
#pragma once

#include <optional>
#include <vector>

#include "core/check/recording_check.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/camera_and_planes.h"

namespace glidelab::core {

struct CheckedPattern {
  PatternCheck check;
  std::optional<SeenPattern> seen;  ///< the corners and the camera, where there is one
};

/// For an experiment with [calibration]; pictures are read `jobs` at a time. What is wrong with them is check.failure.
CheckedPattern check_pattern(const Experiment& experiment, int jobs);

/// How much of a path lies within the outline of all corners seen, where the lens is known; nothing of no path, or
/// where fewer than three corners are seen.
std::optional<double> share_inside(const PatternCheck& pattern, const std::vector<PixelPlace>& path);

}  // namespace glidelab::core
