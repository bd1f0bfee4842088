/// The line of a motion (or of a thread) by total least squares, x as the distance along it, and the effect of an error
/// of the camera or the plane on both.
#pragma once

#include <opencv2/core.hpp>

#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/pictures/camera/restitution.h"

namespace glidelab::core {

/// A straight line in a plane; `direction` has length 1.
struct PlaneLine {
  cv::Point2d through;  ///< the points' mean
  cv::Point2d direction;
  double rms_across = 0.0;    ///< distance of the points from the line, without those left out
  double sd_angle_rad = 0.0;  ///< of the direction, from rms_across; larger if the errors of neighbouring points
                              ///< correlate
  std::size_t used = 0;       ///< points with a weight above one half
  double along(cv::Point2d point) const { return (point - through).dot(direction); }
  double across(cv::Point2d point) const { return direction.cross(point - through); }
};

/// Robust total least squares: from the line of least median distance (thinned out where points crowd) on, the
/// principal axis of the points, weighted by Tukey's biweight of their distance (6 scaled median deviations, of at
/// least `least_scale`), iterated. Points' unit is the line's unit. Needs two different points; NumericalError
/// otherwise.
PlaneLine fit_plane_line(const std::vector<cv::Point2d>& points, double least_scale);

/// The line in which a marker moves, directed downhill.
class MotionAxis {
 public:
  /// `downhill`: the direction along X or Y that is downhill. NumericalError if the marker does not move.
  static MotionAxis through(const std::vector<cv::Point2d>& points, Downhill downhill);
  /// The same through points that have all moved a little in the same way: this axis is the start, so no search is
  /// needed.
  MotionAxis moved_through(const std::vector<cv::Point2d>& points, Downhill downhill) const;
  /// Along X or Y itself, for a marker that does not move.
  static MotionAxis along(Downhill downhill);

  /// This axis, rotated by the angle between two directions.
  MotionAxis turned(const MotionAxis& to, const MotionAxis& from) const;

  /// Distance along the line from the projection of the plane's origin, positive downhill.
  double x_of(cv::Point2d point) const { return point.dot(line_.direction); }
  const PlaneLine& line() const { return line_; }
  /// Angle from the X axis to the undirected line, in (-pi/2, pi/2].
  double angle_to_x_rad() const;

 private:
  static MotionAxis directed(const PlaneLine& line, Downhill downhill);

  PlaneLine line_;
};

/// The effect of an error of the camera or the plane on the motion of one group: the line of motion is refitted through
/// the displaced positions, and x is measured along it.
struct ModeAxis {
  RestitutionMode mode;
  MotionAxis axis;

  /// Change of x of these positions for one standard deviation; 0 where the mode has no ray for a position.
  std::vector<double> displacement(const Restitution& restitution, const MotionAxis& without,
                                   const std::vector<cv::Point2d>& places) const;
};

/// One for each of the restitution's modes, in its order; `places` are the positions of all clips of the group. If
/// there are many, an even selection of them determines how a mode turns the line.
std::vector<ModeAxis> mode_axes(const Restitution& restitution, const MotionAxis& without,
                                const std::vector<cv::Point2d>& places, Downhill downhill);

}  // namespace glidelab::core
