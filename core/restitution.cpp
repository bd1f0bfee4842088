#include "core/restitution.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>

#include "base/dense.h"
#include "base/errors.h"

namespace glidelab::core {
namespace {

constexpr int kOutlinePoints =
    48;  // of the marker's outline; an ellipse's centre comes out exactly for any even number

/// The directions from the outline's centre to its points.
const std::array<cv::Point2d, kOutlinePoints> kAround = [] {
  std::array<cv::Point2d, kOutlinePoints> around;
  for (int k = 0; k < kOutlinePoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kOutlinePoints;
    around[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
  }
  return around;
}();

PlanePose pose_from(const Eigen::VectorXd& parameters) {
  PlanePose pose;
  cv::Rodrigues(cv::Vec3d(parameters[0], parameters[1], parameters[2]), pose.rotation);
  pose.shift = cv::Vec3d(parameters[3], parameters[4], parameters[5]);
  return pose;
}

cv::Vec3d turned(const Eigen::VectorXd& parameters, std::size_t view, cv::Point2d at) {
  if (view == 0) return {at.x, at.y, 0.0};
  const Eigen::Index first = 6 + 3 * (static_cast<Eigen::Index>(view) - 1);
  const double c = std::cos(parameters[first]), s = std::sin(parameters[first]);
  return {parameters[first + 1] + c * at.x - s * at.y, parameters[first + 2] + s * at.x + c * at.y, 0.0};
}

/// Model minus datum, u and v of every corner of every view.
Eigen::VectorXd residuals_of(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m,
                             const Eigen::VectorXd& parameters) {
  const PlanePose pose = pose_from(parameters);
  std::size_t count = 0;
  for (const BoardCorners& view : views) count += view.points.size();
  Eigen::VectorXd residuals(static_cast<Eigen::Index>(2 * count));
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < views.size(); ++k) {
    for (int j = 0; j < views[k].grid.height; ++j) {
      for (int i = 0; i < views[k].grid.width; ++i) {
        const cv::Vec3d p = pose.rotation * turned(parameters, k, {i * square_m, j * square_m}) + pose.shift;
        const cv::Point2d pixel = camera.to_pixel({p[0] / p[2], p[1] / p[2]});
        const cv::Point2d seen = views[k].at(i, j);
        residuals[row++] = pixel.x - seen.x;
        residuals[row++] = pixel.y - seen.y;
      }
    }
  }
  return residuals;
}

Eigen::VectorXd start_of(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m) {
  Eigen::VectorXd parameters(static_cast<Eigen::Index>(6 + 3 * (views.size() - 1)));
  PlanePose first;
  for (std::size_t k = 0; k < views.size(); ++k) {
    std::vector<cv::Point3d> objects;
    std::vector<cv::Point2d> images;  // normalised coordinates: the distortion is undone here, once and exactly
    for (int j = 0; j < views[k].grid.height; ++j) {
      for (int i = 0; i < views[k].grid.width; ++i) {
        const auto normalised = camera.to_normalised(views[k].at(i, j));
        if (!normalised) continue;
        objects.emplace_back(i * square_m, j * square_m, 0.0);
        images.push_back(*normalised);
      }
    }
    cv::Vec3d turn, shift;
    if (objects.size() < 6 ||
        !cv::solvePnP(objects, images, cv::Matx33d::eye(), cv::noArray(), turn, shift, false, cv::SOLVEPNP_ITERATIVE)) {
      throw base::NumericalError("the pose of the pattern in the plane of motion cannot be found");
    }
    cv::Matx33d rotation;
    cv::Rodrigues(turn, rotation);
    if (k == 0) {
      first = {rotation, shift};
      for (int i = 0; i < 3; ++i) {
        parameters[i] = turn[i];
        parameters[3 + i] = shift[i];
      }
      continue;
    }
    const cv::Matx33d relative = first.rotation.t() * rotation;
    const cv::Vec3d moved = first.rotation.t() * (shift - first.shift);
    const Eigen::Index at = 6 + 3 * (static_cast<Eigen::Index>(k) - 1);
    parameters[at] = std::atan2(relative(1, 0), relative(0, 0));
    parameters[at + 1] = moved[0];
    parameters[at + 2] = moved[1];
  }
  return parameters;
}

/// Central differences; the parameters are radians and metres, so that 1e-6 is far above rounding (1e-13 px) and the
/// third derivative's share (1e-12) is nothing.
Eigen::MatrixXd jacobian_of(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m,
                            const Eigen::VectorXd& parameters) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd jacobian;
  for (Eigen::Index k = 0; k < parameters.size(); ++k) {
    Eigen::VectorXd up = parameters, down = parameters;
    up[k] += kStep;
    down[k] -= kStep;
    const Eigen::VectorXd column =
        (residuals_of(camera, views, square_m, up) - residuals_of(camera, views, square_m, down)) / (2.0 * kStep);
    if (k == 0) jacobian.resize(column.size(), parameters.size());
    jacobian.col(k) = column;
  }
  return jacobian;
}

/// Gauss-Newton from a start that is already good (solvePnP's); a step that does not lower the cost is halved.
Eigen::VectorXd fit_poses(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m,
                          Eigen::VectorXd parameters) {
  double cost = residuals_of(camera, views, square_m, parameters).squaredNorm();
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Eigen::VectorXd residuals = residuals_of(camera, views, square_m, parameters);
    const Eigen::VectorXd step = base::least_squares(jacobian_of(camera, views, square_m, parameters), -residuals);
    double share = 1.0;
    for (; share > 1e-4; share *= 0.5) {
      const double trial = residuals_of(camera, views, square_m, parameters + share * step).squaredNorm();
      if (!(trial <= cost)) continue;
      parameters += share * step;
      cost = trial;
      break;
    }
    if (step.lpNorm<Eigen::Infinity>() < 1e-11 || share <= 1e-4) break;
  }
  return parameters;
}

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

std::optional<cv::Point2d> meet_plane(const CameraModel& camera, const PlanePose& pose, cv::Point2d pixel, double z) {
  const auto normalised = camera.to_normalised(pixel);
  if (!normalised) return std::nullopt;
  const cv::Vec3d origin = pose.rotation.t() * (-pose.shift);
  const cv::Vec3d ray = pose.rotation.t() * cv::Vec3d(normalised->x, normalised->y, 1.0);
  if (ray[2] == 0.0) return std::nullopt;
  const double reach = (z - origin[2]) / ray[2];
  if (!(reach > 0.0)) return std::nullopt;
  return cv::Point2d(origin[0] + reach * ray[0], origin[1] + reach * ray[1]);
}

}  // namespace

PlaneFit fit_plane(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m,
                   double correlated_px) {
  if (views.empty()) throw base::NumericalError("no plane view to fit");
  const Eigen::VectorXd parameters = fit_poses(camera, views, square_m, start_of(camera, views, square_m));
  const Eigen::VectorXd residuals = residuals_of(camera, views, square_m, parameters);
  const Eigen::MatrixXd jacobian = jacobian_of(camera, views, square_m, parameters);
  const double freedom = static_cast<double>(residuals.size() - parameters.size());
  PlaneFit fit;
  fit.pose = pose_from(parameters);
  fit.rms_px = std::sqrt(residuals.squaredNorm() / static_cast<double>(residuals.size()));
  const CornerNoise noise{std::sqrt(residuals.squaredNorm() / freedom), correlated_px};
  Eigen::MatrixXd spread = jacobian;  // V J
  Eigen::Index row = 0;
  for (const BoardCorners& view : views) {
    const auto rows = static_cast<Eigen::Index>(2 * view.points.size());
    spread.middleRows(row, rows) = times_covariance(noise, view.grid, jacobian.middleRows(row, rows));
    row += rows;
  }
  const Eigen::MatrixXd inverse = base::inverse_positive(base::transposed_product(jacobian, jacobian));
  const Eigen::MatrixXd middle = base::transposed_product(jacobian, spread);
  const Eigen::MatrixXd covariance = base::product(base::product(inverse, middle), inverse);
  fit.covariance = covariance.topLeftCorner<6, 6>();
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < views.size(); ++k) {
    fit.in_plane.push_back(k == 0 ? Eigen::Vector3d::Zero().eval()
                                  : parameters.segment<3>(6 + 3 * (static_cast<Eigen::Index>(k) - 1)).eval());
    for (int j = 0; j < views[k].grid.height; ++j) {
      for (int i = 0; i < views[k].grid.width; ++i) {
        const auto seen = meet_plane(camera, fit.pose, views[k].at(i, j), 0.0);
        if (!seen) continue;
        const cv::Vec3d is = turned(parameters, k, {i * square_m, j * square_m});
        sum += std::pow(seen->x - is[0], 2) + std::pow(seen->y - is[1], 2);
        count += 2.0;
      }
    }
  }
  fit.rms_m = std::sqrt(sum / count);
  return fit;
}

std::optional<std::string> disagreement(const PlaneFit& fit, std::size_t views, const CornerNoise& noise,
                                        const std::string& group) {
  constexpr double kOff = 3.0, kLeastOffPx = 0.05;
  // Of one coordinate; every view's pose takes its share out of the residuals, in the plane as in the camera's fit.
  const double expected_px = std::hypot(noise.white_px, noise.correlated_px);
  if (fit.rms_px <= std::max(kLeastOffPx, kOff * expected_px)) return {};
  return fmt::format(
      "the plane {} of group \"{}\" {} not agree with the camera: the pattern's corners are {:.2g} px (rms) from where "
      "the camera of all views and {} plane put them, and {:.2g} px is what the corners' noise explains",
      views == 1 ? "view" : "views", group, views == 1 ? "does" : "do", fit.rms_px, views == 1 ? "a" : "one",
      expected_px);
}

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

/// Centre of the outline (the area's centroid) minus the projection of the sphere's centre, in pixels.
cv::Point2d Restitution::outline_offset(cv::Point2d plane) const {
  const cv::Vec3d centre = plane_->pose.rotation * cv::Vec3d(plane.x, plane.y, -height_m_) + plane_->pose.shift;
  const double distance = cv::norm(centre);
  if (!(distance > radius_m_)) return {0.0, 0.0};
  // The rays that touch the sphere touch it on a circle, nearer than the centre by R^2 / D and a little smaller.
  const cv::Vec3d along = centre / distance;
  const cv::Vec3d any = std::abs(along[0]) < 0.7 ? cv::Vec3d(1, 0, 0) : cv::Vec3d(0, 1, 0);
  const cv::Vec3d across = cv::normalize(along.cross(any));
  const cv::Vec3d other = along.cross(across);
  const double share = radius_m_ / distance;
  const cv::Vec3d middle = centre * (1.0 - share * share);
  const double rim = radius_m_ * std::sqrt(1.0 - share * share);
  const cv::Point2d reference = calibration_.camera.to_pixel({centre[0] / centre[2], centre[1] / centre[2]});
  std::array<cv::Point2d, kOutlinePoints> outline;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const cv::Vec3d p = middle + rim * (kAround[k].x * across + kAround[k].y * other);
    outline[k] = calibration_.camera.to_pixel({p[0] / p[2], p[1] / p[2]}) - reference;
  }
  double area = 0.0;
  cv::Point2d moment;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const cv::Point2d a = outline[k];
    const cv::Point2d b = outline[(k + 1) % outline.size()];
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
  // Mean of the radii along the picture's two axes, from the scale along and across the plane.
  const cv::Point2d centre = project({plane->x, plane->y, -height_m_});
  const cv::Vec3d c = plane_->pose.rotation * cv::Vec3d(plane->x, plane->y, -height_m_) + plane_->pose.shift;
  const cv::Point2d right = calibration_.camera.to_pixel({(c[0] + radius_m_) / c[2], c[1] / c[2]});
  const cv::Point2d down = calibration_.camera.to_pixel({c[0] / c[2], (c[1] + radius_m_) / c[2]});
  return 0.5 * (cv::norm(right - centre) + cv::norm(down - centre));
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
  constexpr double kSds = 0.25;
  Eigen::VectorXd parameters(static_cast<Eigen::Index>(6 + 3 * (views_.size() - 1)));
  cv::Vec3d turn;
  cv::Rodrigues(plane_->pose.rotation, turn);
  for (int i = 0; i < 3; ++i) {
    parameters[i] = turn[i];
    parameters[3 + i] = plane_->pose.shift[i];
  }
  for (std::size_t k = 1; k < views_.size(); ++k) {
    parameters.segment<3>(6 + 3 * (static_cast<Eigen::Index>(k) - 1)) = plane_->in_plane[k];
  }
  const Eigen::MatrixXd of_camera = square_root(calibration_.covariance);
  for (Eigen::Index k = 0; k < of_camera.cols(); ++k) {
    const CameraModel camera = calibration_.camera.moved(kSds * of_camera.col(k));
    const PlanePose pose = pose_from(fit_poses(camera, views_, square_m_, parameters));
    modes.push_back({camera, pose, height_m_, kSds, true});
  }
  const Eigen::MatrixXd of_pose = square_root(plane_->covariance);
  for (Eigen::Index k = 0; k < of_pose.cols(); ++k) {
    const Eigen::VectorXd moved = parameters.head<6>() + kSds * of_pose.col(k);
    modes.push_back({calibration_.camera, pose_from(moved), height_m_, kSds, false});
  }
  return modes;
}

}  // namespace glidelab::core
