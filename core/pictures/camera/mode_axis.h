/// The effect of an error of the camera or the plane on the motion of one group: the line of motion is refitted through
/// the displaced positions, and x is measured along it.
#pragma once

#include <opencv2/core.hpp>

#include <vector>

#include "core/pictures/camera/motion_axis.h"
#include "core/pictures/camera/restitution.h"

namespace glidelab::core {

struct ModeAxis {
  RestitutionMode mode;
  MotionAxis axis;

  /// Change of x of these places by one standard deviation; 0 where the mode has no ray for a place.
  std::vector<double> displacement(const Restitution& restitution, const MotionAxis& without,
                                   const std::vector<cv::Point2d>& places) const;
};

/// One for each of the restitution's modes, in its order; `places` are those of all clips of the group. If there are
/// many, an even selection of them determines how a mode turns the line.
std::vector<ModeAxis> mode_axes(const Restitution& restitution, const MotionAxis& without,
                                const std::vector<cv::Point2d>& places, int downhill);

}  // namespace glidelab::core
