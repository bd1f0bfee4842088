#include "core/pictures/camera/mode_axis.h"

#include <cmath>

namespace glidelab::core {
namespace {

constexpr std::size_t kMostPlacesUsed = 1500;  // places say how a smooth displacement turns the line

}  // namespace

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
  const std::size_t stride = places.size() / kMostPlacesUsed + 1;
  std::vector<cv::Point2d> some, pixels;
  for (std::size_t i = 0; i < places.size(); i += stride) {
    some.push_back(places[i]);
    pixels.push_back(restitution.centre_pixel(places[i]));
  }
  const bool moves = std::isfinite(without.line().sd_angle_rad);  // else the marker rests, and x runs along X
  const MotionAxis before = moves && stride > 1 ? without.moved_through(some, downhill) : without;
  std::vector<ModeAxis> axes;
  for (const RestitutionMode& mode : restitution.modes()) {
    ModeAxis moved{mode, without};
    if (moves) {
      std::vector<cv::Point2d> displaced;
      for (std::size_t i = 0; i < some.size(); ++i) displaced.push_back(mode.to_plane(pixels[i]).value_or(some[i]));
      moved.axis = without.turned(before.moved_through(displaced, downhill), before);
    }
    axes.push_back(moved);
  }
  return axes;
}

}  // namespace glidelab::core
