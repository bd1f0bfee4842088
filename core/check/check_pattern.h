/// The images of the pattern before any analysis: in which of them it is found, how well one camera explains them, how
/// much of the image they cover.
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

/// For an experiment with [calibration]; images are read `jobs` at a time. check.failure says what is wrong with them.
CheckedPattern check_pattern(const Experiment& experiment, int jobs);

/// The share of a path that lies within the convex hull of all corners, where the lens is known; nothing for an empty
/// path or fewer than three corners.
std::optional<double> share_inside(const PatternCheck& pattern, const std::vector<PixelPlace>& path);

}  // namespace glidelab::core
