/// The plane of motion before a calibrated camera: the pose of the pattern in one or more plane views, by least squares
/// over their corners with the camera held.
///
/// The views share one plane: the first one's pattern has a pose X_CP of six parameters, every further one lies in the
/// same plane, turned and shifted (three more). Start: solvePnP of each view, its corners' distortion undone; then
/// Gauss-Newton with central differences. Covariance of the pose: (J'J)^-1 J'V J (J'J)^-1, V that of corner_errors.h
/// with the white part taken from the residuals.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <optional>
#include <string>
#include <vector>

#include "core/pictures/board/chessboard.h"
#include "core/pictures/board/corner_errors.h"
#include "core/pictures/camera/camera_model.h"
#include "core/result/analysis_note.h"

namespace glidelab::core {

/// X_CP: p_C = rotation * p_P + shift.
struct PlanePose {
  cv::Matx33d rotation = cv::Matx33d::eye();
  cv::Vec3d shift;
};

struct PlaneFit {
  PlanePose pose;                          ///< of the first plane view
  std::vector<Eigen::Vector3d> in_plane;   ///< each view's pattern in the first one's frame: turn [rad], X, Y [m]
  Eigen::Matrix<double, 6, 6> covariance;  ///< of (turn vector, shift) of `pose`, the camera held
  double rms_m = 0.0;                      ///< of the corners, restituted, against the pattern (one coordinate)
  double rms_px = 0.0;                     ///< the same in the image
};

/// Pose of the pattern in one or more plane views, with the camera held. `correlated_px`: the part of the corners'
/// errors that neighbours share (CornerNoise); the independent part is taken from the residuals.
PlaneFit fit_plane(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m,
                   double correlated_px = 0.0);

/// A note if the corners of the plane views lie further from where the camera and one plane place them than three
/// times their own noise (views differ in sharpness and tilt, and so in noise) and than 0.05 px (less is harmless);
/// `group` names the views.
std::optional<PlaneViewsDisagree> disagreement(const PlaneFit& fit, std::size_t views, const CornerNoise& noise,
                                               const std::string& group);

/// The pose for another camera: the views of `start` fitted again from there.
PlanePose refit_pose(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m,
                     const PlaneFit& start);

/// The pose with this change of (turn vector, shift), of which PlaneFit::covariance is the covariance.
PlanePose moved(const PlanePose& pose, const Eigen::Matrix<double, 6, 1>& change);

/// Where the ray of a pixel meets the plane Z = z of the pattern's frame P, metres; empty if no ray belongs to the
/// pixel or it does not meet the plane in front of the camera.
std::optional<cv::Point2d> meet_plane(const CameraModel& camera, const PlanePose& pose, cv::Point2d pixel, double z_m);

}  // namespace glidelab::core
