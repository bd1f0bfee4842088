#include "core/mode_axis.h"

#include <cmath>

namespace glidelab::core {

std::vector<double> ModeAxis::displacement(const Restitution& restitution, const MotionAxis& without,
                                           const std::vector<cv::Point2d>& places) const {
  std::vector<double> change;
  change.reserve(places.size());
  for (const cv::Point2d& place : places) {
    const auto moved = mode.to_plane(restitution.centre_pixel(place));
    change.push_back(moved ? (axis.x_of(*moved) - without.x_of(place)) / mode.sds : 0.0);
  }
  return change;
}

std::vector<ModeAxis> mode_axes(const Restitution& restitution, const MotionAxis& without,
                                const std::vector<cv::Point2d>& places, int downhill) {
  std::vector<ModeAxis> axes;
  for (const RestitutionMode& mode : restitution.modes()) {
    ModeAxis moved{mode, without};
    if (std::isfinite(without.line().sd_angle_rad)) {  // else the marker rests, and x runs along X
      std::vector<cv::Point2d> displaced;
      for (const cv::Point2d& place : places) {
        displaced.push_back(mode.to_plane(restitution.centre_pixel(place)).value_or(place));
      }
      moved.axis = MotionAxis::through(displaced, downhill);
    }
    axes.push_back(moved);
  }
  return axes;
}

}  // namespace glidelab::core
