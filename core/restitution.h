/// From a pixel to metres in the plane of motion, and back.
///
/// With a pattern: pixel -> ray (distortion undone) -> the point where the ray meets the plane Z = -height_m of the
/// pattern's frame P, that is the plane in which the marker's centre moves. P's pose comes from the plane views by
/// least squares with the calibrated camera; several of them share one plane and differ by a motion in it. The outline
/// of a sphere is not centred on the projection of its centre (its image is nearly an ellipse, shifted away from the
/// axis); that is corrected from the marker's diameter. With one scale: X = u / px_per_m, Y = v / px_per_m.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "core/calibrate.h"
#include "core/experiment.h"

namespace glidelab::core {

/// X_CP: p_C = rotation * p_P + shift.
struct PlanePose {
  cv::Matx33d rotation = cv::Matx33d::eye();
  cv::Vec3d shift;
};

struct PlaneFit {
  PlanePose pose;                          ///< of the first plane view
  std::vector<Eigen::Vector3d> in_plane;   ///< each view's pattern in the first one's frame: turn [rad], X, Y [m]
  Eigen::Matrix<double, 6, 6> covariance;  ///< of (turn vector, shift) of `pose`
  double rms_m = 0.0;                      ///< of the corners, restituted, against the pattern (one coordinate)
  double rms_px = 0.0;                     ///< the same in the picture
};

/// Pose of the pattern in one or more plane views, with the camera held.
PlaneFit fit_plane(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m);

class Restitution {
 public:
  static Restitution from_pattern(const Calibration& calibration, const std::vector<BoardCorners>& planes,
                                  double square_m, double marker_height_m, double marker_diameter_m);
  static Restitution from_scale(const ScaleSetup& scale, double marker_diameter_m);

  /// Where the marker's centre is that is seen centred on this pixel; metres in P. Nothing where no ray belongs to the
  /// pixel or it does not meet the plane before the camera.
  std::optional<cv::Point2d> to_plane(cv::Point2d pixel) const;

  /// The pixel on which a marker at this place is seen centred; the inverse of to_plane.
  cv::Point2d to_pixel(cv::Point2d plane) const;

  /// The pixel with the lens's distortion undone (as a camera without it would show it); the pixel itself with a scale.
  std::optional<cv::Point2d> undistorted(cv::Point2d pixel) const;

  /// Radius of the marker's image there, in pixels; nothing where to_plane gives nothing.
  std::optional<double> marker_radius_px(cv::Point2d pixel) const;

  /// Relative standard deviation of the distance between two pixels' places, from the camera's and the plane's
  /// covariance, or as stated with the scale.
  double relative_scale_sd(cv::Point2d from, cv::Point2d to) const;

  /// What the plane views gave; nothing for a scale.
  const std::optional<PlaneFit>& plane() const { return plane_; }

 private:
  Restitution() = default;
  std::optional<cv::Point2d> intersect(const CameraModel& camera, const PlanePose& pose, cv::Point2d pixel) const;
  cv::Point2d project(cv::Vec3d point_in_p) const;
  cv::Point2d outline_offset(cv::Point2d plane) const;

  std::optional<ScaleSetup> scale_;
  Calibration calibration_;
  std::vector<BoardCorners> views_;
  double square_m_ = 0.0;
  std::optional<PlaneFit> plane_;
  double height_m_ = 0.0;
  double radius_m_ = 0.0;
};

}  // namespace glidelab::core
