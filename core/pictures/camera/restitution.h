/// From a pixel to metres in the plane of motion and back, and the calibration that makes this mapping for every group.
///
/// With a pattern: pixel -> ray (distortion undone) -> the point where the ray meets the plane Z = -height_m of the
/// pattern's frame P, that is the plane in which the marker's centre moves. P's pose comes from the plane views by
/// least squares with the calibrated camera; several of them share one plane and differ by a motion in it. The outline
/// of a sphere is not centred on the projection of its centre (its image is nearly an ellipse, shifted away from the
/// axis), nor is that of a disc where the plane is tilted or the lens bends; that is corrected from the marker's
/// diameter. With one scale: X = u / px_per_m, Y = v / px_per_m.
///
/// Uncertainty: the camera's covariance and, with the camera held, that of the plane's pose are each split into
/// independent modes (the columns of a square root of the covariance). A mode is the camera and the pose as an error of
/// some standard deviations would have made them, the pose following the camera by a new fit of the plane views. Places
/// restituted with it, minus those restituted without, are the signed displacements that such an error causes.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/camera/calibrate.h"
#include "core/pictures/camera/plane_fit.h"
#include "core/result/results.h"

namespace glidelab::core {

/// The mapping from pixels to the plane with an error of `sds` standard deviations in one independent direction.
struct RestitutionMode {
  CameraModel camera;
  PlanePose pose;
  double height_m = 0.0;
  double sds = 0.0;
  bool of_camera = false;  ///< else of this plane's pose alone

  /// The position of a marker's centre that is projected onto this pixel (Restitution::centre_pixel).
  std::optional<cv::Point2d> to_plane(cv::Point2d centre_pixel) const;
};

class Restitution {
 public:
  static Restitution from_pattern(const Calibration& calibration, const std::vector<BoardCorners>& planes,
                                  double square_m, double marker_height_m, double marker_diameter_m);
  static Restitution from_scale(const ScaleSetup& scale, double marker_diameter_m);

  /// The marker is a disc in the plane of motion; otherwise it is a sphere.
  void take_for_disc() { disc_ = true; }
  bool is_disc() const { return disc_; }

  /// The position, metres in P, of the centre of a marker that is seen centred on this pixel. Nothing if no ray belongs
  /// to the pixel or it does not meet the plane in front of the camera.
  std::optional<cv::Point2d> to_plane(cv::Point2d pixel) const;

  /// The pixel on which a marker at this position is seen centred; the inverse of to_plane.
  cv::Point2d to_pixel(cv::Point2d plane) const;

  /// The pixel with the lens's distortion undone (as a camera without it would show it); the pixel itself with a scale.
  std::optional<cv::Point2d> undistorted(cv::Point2d pixel) const;

  /// Radius of the marker's image there, in pixels; empty where to_plane is.
  std::optional<double> marker_radius_px(cv::Point2d pixel) const;

  /// The outline of the marker, a sphere, that is seen centred on this pixel: |M d| = 1 about it, as the elements uu,
  /// uv, vv of M (1/px); empty where to_plane is.
  std::optional<cv::Vec3d> marker_shape(cv::Point2d pixel) const;

  /// The same of a disc of the marker's diameter that lies in the plane in which its centre moves.
  std::optional<cv::Vec3d> disc_shape(cv::Point2d pixel) const;

  /// The pixel onto which the marker's centre is projected, which is not where its outline is centred.
  cv::Point2d centre_pixel(cv::Point2d plane) const;

  /// Relative standard deviation of px_per_m, as stated with the scale; 0 with a pattern, whose scale is in the modes.
  double relative_scale_sd() const { return scale_ ? scale_->px_per_m_sd / scale_->px_per_m : 0.0; }

  /// The camera's modes come first and are the same, in the same order, for every plane of one calibration. None with a
  /// scale.
  std::vector<RestitutionMode> modes() const;

  /// The fit of the plane views; empty for a scale.
  const std::optional<PlaneFit>& plane() const { return plane_; }

 private:
  Restitution() = default;
  std::optional<cv::Point2d> intersect(cv::Point2d pixel) const;
  cv::Point2d project(cv::Vec3d point_in_p) const;
  std::vector<cv::Point2d> sphere_outline(cv::Point2d plane) const;
  std::vector<cv::Point2d> disc_outline(cv::Point2d plane) const;
  cv::Point2d outline_offset(cv::Point2d plane) const;

  std::optional<ScaleSetup> scale_;
  Calibration calibration_;
  std::vector<BoardCorners> views_;
  double square_m_ = 0.0;
  std::optional<PlaneFit> plane_;
  double height_m_ = 0.0;
  double radius_m_ = 0.0;
  bool disc_ = false;
};

/// The pattern's corners, as found in pattern_files(), and the camera calibrated from them.
struct SeenPattern {
  BoardViews boards;
  Calibration calibration;
};

struct CameraAndPlanes {
  std::optional<cv::Size> size;  ///< of the images; nothing with a scale alone
  std::optional<CalibrationResult> calibration;
  std::map<std::string, Restitution> restitutions;  ///< of the groups that have filmed clips
};

/// The images of the plane of motion, of a group or else of [calibration].
std::vector<std::filesystem::path> planes_of(const Experiment& experiment, const std::string& group);

/// All images of the pattern: views, then planes, then those of groups that have filmed clips. Some may occur twice.
std::vector<std::filesystem::path> pattern_files(const Experiment& experiment);

/// From the images of the pattern to the camera and, for each group, the mapping from pixels to its plane of motion.
/// For an experiment with filmed clips. `seen`: the pattern, if it was found before; null: its images are read, `jobs`
/// at a time. InputError for images that cannot be used.
CameraAndPlanes camera_and_planes_of(const Experiment& experiment, int jobs, const SeenPattern* seen = nullptr,
                                     const base::Progress& progress = base::no_progress);

}  // namespace glidelab::core
