#include "core/pictures/camera/restitution.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "base/errors.h"
#include "base/math/dense.h"
#include "core/pictures/camera/calibrate.h"

namespace glidelab::core {
namespace {

/// Of the marker's outline; an ellipse's centre comes out exactly for any even number.
constexpr int kOutlinePoints = 48;

/// The directions from the outline's centre to its points.
const std::array<cv::Point2d, kOutlinePoints> kAround = [] {
  std::array<cv::Point2d, kOutlinePoints> around;
  for (int k = 0; k < kOutlinePoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kOutlinePoints;
    around[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
  }
  return around;
}();

/// Columns whose products sum up to the covariance, one for each direction that has a variance: the eigenvectors of
/// the correlations, so that the parameters' units do not matter.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& covariance) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < covariance.rows(); ++k) {
    if (covariance(k, k) > 0.0) free.push_back(k);
  }
  const auto size = static_cast<Eigen::Index>(free.size());
  if (size == 0) return Eigen::MatrixXd::Zero(covariance.rows(), 0);
  Eigen::VectorXd sd(size);
  for (Eigen::Index k = 0; k < size; ++k)
    sd[k] = std::sqrt(covariance(free[static_cast<std::size_t>(k)], free[static_cast<std::size_t>(k)]));
  const Eigen::MatrixXd part = covariance(free, free);
  const Eigen::MatrixXd correlations = sd.cwiseInverse().asDiagonal() * part * sd.cwiseInverse().asDiagonal();
  const base::SymmetricEigen eigen = base::symmetric_eigen(correlations);
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(covariance.rows(), size);
  root(free, Eigen::all) = sd.asDiagonal() * eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return root;
}

}  // namespace

Restitution Restitution::from_pattern(const Calibration& calibration, const std::vector<BoardCorners>& planes,
                                      double square_m, double marker_height_m, double marker_diameter_m) {
  Restitution restitution;
  restitution.calibration_ = calibration;
  restitution.views_ = planes;
  restitution.square_m_ = square_m;
  restitution.plane_ = fit_plane(calibration.camera, planes, square_m, calibration.noise.correlated_px);
  restitution.height_m_ = marker_height_m;
  restitution.radius_m_ = 0.5 * marker_diameter_m;
  return restitution;
}

Restitution Restitution::from_scale(const ScaleSetup& scale, double marker_diameter_m) {
  Restitution restitution;
  restitution.scale_ = scale;
  restitution.radius_m_ = 0.5 * marker_diameter_m;
  return restitution;
}

cv::Point2d Restitution::project(cv::Vec3d point_in_p) const {
  const cv::Vec3d p = plane_->pose.rotation * point_in_p + plane_->pose.shift;
  return calibration_.camera.to_pixel({p[0] / p[2], p[1] / p[2]});
}

/// Points of the outline about the projection of the sphere's centre, in pixels; none for a point.
std::vector<cv::Point2d> Restitution::sphere_outline(cv::Point2d plane) const {
  const cv::Vec3d centre = plane_->pose.rotation * cv::Vec3d(plane.x, plane.y, -height_m_) + plane_->pose.shift;
  const double distance = cv::norm(centre);
  if (!(distance > radius_m_)) return {};
  // The rays that touch the sphere touch it on a circle, nearer than the centre by R^2 / D and a little smaller.
  const cv::Vec3d along = centre / distance;
  const cv::Vec3d any = std::abs(along[0]) < 0.7 ? cv::Vec3d(1, 0, 0) : cv::Vec3d(0, 1, 0);
  const cv::Vec3d across = cv::normalize(along.cross(any));
  const cv::Vec3d other = along.cross(across);
  const double share = radius_m_ / distance;
  const cv::Vec3d middle = centre * (1.0 - share * share);
  const double rim = radius_m_ * std::sqrt(1.0 - share * share);
  const cv::Point2d reference = calibration_.camera.to_pixel({centre[0] / centre[2], centre[1] / centre[2]});
  std::vector<cv::Point2d> outline(kAround.size());
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const cv::Vec3d p = middle + rim * (kAround[k].x * across + kAround[k].y * other);
    outline[k] = calibration_.camera.to_pixel({p[0] / p[2], p[1] / p[2]}) - reference;
  }
  return outline;
}

std::vector<cv::Point2d> Restitution::disc_outline(cv::Point2d plane) const {
  const cv::Point2d reference = project({plane.x, plane.y, -height_m_});
  std::vector<cv::Point2d> outline;
  for (const cv::Point2d& around : kAround) {
    const cv::Point2d at = plane + radius_m_ * around;
    outline.push_back(project({at.x, at.y, -height_m_}) - reference);
  }
  return outline;
}

/// Centre of the outline (the area's centroid) minus the projection of the marker's centre, in pixels.
cv::Point2d Restitution::outline_offset(cv::Point2d plane) const {
  const std::vector<cv::Point2d> points = disc_ ? disc_outline(plane) : sphere_outline(plane);
  if (points.empty()) return {0.0, 0.0};
  double area = 0.0;
  cv::Point2d moment;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const cv::Point2d a = points[k];
    const cv::Point2d b = points[(k + 1) % points.size()];
    const double cross = a.cross(b);
    area += cross;
    moment += (a + b) * cross;
  }
  return moment / (3.0 * area);
}

std::optional<cv::Point2d> Restitution::intersect(cv::Point2d pixel) const {
  return meet_plane(calibration_.camera, plane_->pose, pixel, -height_m_);
}

std::optional<cv::Point2d> Restitution::to_plane(cv::Point2d pixel) const {
  if (scale_) return cv::Point2d(pixel.x / scale_->px_per_m, pixel.y / scale_->px_per_m);
  const auto first = intersect(pixel);
  if (!first || radius_m_ == 0.0) return first;
  // The offset varies slowly: a second step, from the place that the first one gave, is good to a millionth of it.
  const auto second = intersect(pixel - outline_offset(*first));
  if (!second) return std::nullopt;
  return intersect(pixel - outline_offset(*second));
}

cv::Point2d Restitution::to_pixel(cv::Point2d plane) const {
  if (scale_) return plane * scale_->px_per_m;
  const cv::Point2d centre = project({plane.x, plane.y, -height_m_});
  return radius_m_ == 0.0 ? centre : centre + outline_offset(plane);
}

std::optional<cv::Point2d> Restitution::undistorted(cv::Point2d pixel) const {
  if (scale_) return pixel;
  const CameraModel& camera = calibration_.camera;
  const auto normalised = camera.to_normalised(pixel);
  if (!normalised) return std::nullopt;
  return cv::Point2d(camera.fx * normalised->x + camera.cx, camera.fy * normalised->y + camera.cy);
}

std::optional<double> Restitution::marker_radius_px(cv::Point2d pixel) const {
  if (scale_) return radius_m_ * scale_->px_per_m;
  const auto plane = intersect(pixel);
  if (!plane) return std::nullopt;
  // Mean of the radii along the image's two axes, from the scale along and across the plane.
  const cv::Point2d centre = project({plane->x, plane->y, -height_m_});
  const cv::Vec3d c = plane_->pose.rotation * cv::Vec3d(plane->x, plane->y, -height_m_) + plane_->pose.shift;
  const cv::Point2d right = calibration_.camera.to_pixel({(c[0] + radius_m_) / c[2], c[1] / c[2]});
  const cv::Point2d down = calibration_.camera.to_pixel({c[0] / c[2], (c[1] + radius_m_) / c[2]});
  return 0.5 * (cv::norm(right - centre) + cv::norm(down - centre));
}

namespace {

/// M of the ellipse through these points at even steps of its angle, whose covariance is M^-2 / 2.
cv::Vec3d ellipse_through(const std::vector<cv::Point2d>& points) {
  const auto count = static_cast<double>(points.size());
  cv::Point2d middle;
  for (const cv::Point2d& point : points) middle += point / count;
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  for (const cv::Point2d& point : points) {
    const Eigen::Vector2d off(point.x - middle.x, point.y - middle.y);
    square += off * off.transpose() * (2.0 / count);
  }
  // The root of a 2 x 2 matrix A is (A + s 1) / t with s = sqrt(det A), t = sqrt(tr A + 2 s).
  const double s = std::sqrt(square.determinant()), t = std::sqrt(square.trace() + 2.0 * s);
  const Eigen::Matrix2d m = ((square + s * Eigen::Matrix2d::Identity()) / t).inverse();
  return {m(0, 0), m(0, 1), m(1, 1)};
}

}  // namespace

std::optional<cv::Vec3d> Restitution::marker_shape(cv::Point2d pixel) const {
  if (!(radius_m_ > 0.0)) return std::nullopt;
  if (scale_) return cv::Vec3d(1.0, 0.0, 1.0) / (radius_m_ * scale_->px_per_m);
  const auto plane = intersect(pixel);
  if (!plane) return std::nullopt;
  const std::vector<cv::Point2d> points = sphere_outline(*plane);
  if (points.empty()) return std::nullopt;
  return ellipse_through(points);
}

std::optional<cv::Vec3d> Restitution::disc_shape(cv::Point2d pixel) const {
  if (scale_) return marker_shape(pixel);
  if (!(radius_m_ > 0.0)) return std::nullopt;
  const auto plane = intersect(pixel);
  if (!plane) return std::nullopt;
  return ellipse_through(disc_outline(*plane));
}

cv::Point2d Restitution::centre_pixel(cv::Point2d plane) const {
  return scale_ ? plane * scale_->px_per_m : project({plane.x, plane.y, -height_m_});
}

std::optional<cv::Point2d> RestitutionMode::to_plane(cv::Point2d centre_pixel) const {
  return meet_plane(camera, pose, centre_pixel, -height_m);
}

std::vector<RestitutionMode> Restitution::modes() const {
  std::vector<RestitutionMode> modes;
  if (scale_) return modes;
  // A quarter of a standard deviation: far above the fits' rounding, and small beside what bends the response.
  constexpr double kStepSds = 0.25;
  const Eigen::MatrixXd of_camera = square_root(calibration_.covariance);
  for (Eigen::Index k = 0; k < of_camera.cols(); ++k) {
    const CameraModel camera = calibration_.camera.moved(kStepSds * of_camera.col(k));
    modes.push_back({camera, refit_pose(camera, views_, square_m_, *plane_), height_m_, kStepSds, true});
  }
  const Eigen::MatrixXd of_pose = square_root(plane_->covariance);
  for (Eigen::Index k = 0; k < of_pose.cols(); ++k) {
    modes.push_back({calibration_.camera, moved(plane_->pose, kStepSds * of_pose.col(k)), height_m_, kStepSds, false});
  }
  return modes;
}

namespace fs = std::filesystem;

std::vector<fs::path> planes_of(const Experiment& experiment, const std::string& group) {
  const GroupSetup* setup = group_of(experiment, group);
  return setup != nullptr && !setup->planes.empty() ? setup->planes : experiment.calibration->planes;
}

namespace {

std::set<std::string> filmed_groups(const Experiment& experiment) {
  std::set<std::string> names;
  for (const ClipSetup& clip : experiment.clips) {
    if (!clip.file.empty()) names.insert(clip.group);
  }
  return names;
}

}  // namespace

std::vector<fs::path> pattern_files(const Experiment& experiment) {
  const CalibrationSetup& setup = *experiment.calibration;
  std::vector<fs::path> files = setup.views;
  files.insert(files.end(), setup.planes.begin(), setup.planes.end());
  for (const std::string& name : filmed_groups(experiment)) {
    const std::vector<fs::path> planes = planes_of(experiment, name);
    files.insert(files.end(), planes.begin(), planes.end());
  }
  return files;
}

namespace {

CameraAndPlanes calibrated(const Experiment& experiment, int jobs, const SeenPattern* seen,
                           const base::Progress& progress) {
  const CalibrationSetup& setup = *experiment.calibration;
  const BoardViews boards =
      seen != nullptr
          ? seen->boards
          : find_board_views(pattern_files(experiment), cv::Size(setup.inner_corners.columns, setup.inner_corners.rows),
                             jobs, most_pixels_of(experiment), progress);
  const auto corners_in = [&](const fs::path& file) -> const BoardCorners& {
    for (const BoardView& view : boards.views) {
      if (view.file == file) return view.corners;
    }
    throw base::InputError(base::Issue{
        file.string(), 0, "calibration.plane", "no pattern in sight",
        fmt::format("all {} x {} inner corners in sight", setup.inner_corners.columns, setup.inner_corners.rows)});
  };

  CameraAndPlanes setting;
  std::vector<std::pair<std::string, std::vector<BoardCorners>>> planes;
  for (const std::string& name : filmed_groups(experiment)) {
    planes.emplace_back(name, std::vector<BoardCorners>{});
    for (const fs::path& file : planes_of(experiment, name)) planes.back().second.push_back(corners_in(file));
  }
  const Calibration calibration = seen != nullptr ? seen->calibration : calibrate_any_lens(boards, setup.square_m);
  setting.size = calibration.camera.size;
  CalibrationResult result;
  result.experiment = experiment.name;
  result.rms_px = calibration.rms_px;
  const CameraModel& camera = calibration.camera;
  result.camera_matrix = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  result.distortion.assign(camera.distortion.begin(), camera.distortion.end());
  if (camera.lens == LensKind::fisheye) result.distortion.resize(4);
  for (Eigen::Index k = 0; k < calibration.covariance.rows(); ++k) {
    result.sd.push_back(std::sqrt(calibration.covariance(k, k)));
  }
  result.lens = calibration.lens;
  result.views_used = calibration.views_used;
  result.rests = calibration.rests;
  result.notes = calibration.notes;
  double sum = 0.0, count = 0.0;
  for (const auto& [name, corners] : planes) {
    const auto [place, is_new] = setting.restitutions.emplace(
        name, Restitution::from_pattern(calibration, corners, setup.square_m, experiment.marker->height_m,
                                        experiment.marker->diameter_m));
    const PlaneFit& fit = *place->second.plane();
    const auto views = static_cast<double>(corners.size());
    sum += views * fit.rms_m * fit.rms_m;
    count += views;
    result.plane_rms_px = std::max(result.plane_rms_px, fit.rms_px);
    result.plane_expected_px = std::hypot(calibration.noise.white_px, calibration.noise.correlated_px);
    const auto warning = disagreement(fit, corners.size(), calibration.noise, name);
    if (warning) result.notes.emplace_back(*warning);
  }
  result.restitution_rms_m = std::sqrt(sum / count);
  setting.calibration = std::move(result);
  return setting;
}

}  // namespace

CameraAndPlanes camera_and_planes_of(const Experiment& experiment, int jobs, const SeenPattern* seen,
                                     const base::Progress& progress) {
  if (experiment.calibration) return calibrated(experiment, jobs, seen, progress);
  CameraAndPlanes setting;
  for (const std::string& name : filmed_groups(experiment)) {
    setting.restitutions.emplace(name, Restitution::from_scale(*experiment.scale, experiment.marker->diameter_m));
  }
  return setting;
}

}  // namespace glidelab::core
