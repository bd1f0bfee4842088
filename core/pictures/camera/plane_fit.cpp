#include "core/pictures/camera/plane_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "base/errors.h"
#include "base/math/dense.h"
#include "base/math/levenberg_marquardt.h"

namespace glidelab::core {
namespace {

// Parameters: turn vector and shift of the first view's pose; of each further view its turn, X, Y in the first one's
// plane.
constexpr Eigen::Index kOfPose = 6, kOfView = 3;

Eigen::Index first_of(std::size_t view) {
  return kOfPose + kOfView * (static_cast<Eigen::Index>(view) - 1);
}

Eigen::Index parameters_of(std::size_t views) {
  return first_of(views);
}

PlanePose pose_from(const Eigen::VectorXd& parameters) {
  PlanePose pose;
  cv::Rodrigues(cv::Vec3d(parameters[0], parameters[1], parameters[2]), pose.rotation);
  pose.shift = cv::Vec3d(parameters[3], parameters[4], parameters[5]);
  return pose;
}

/// The position of a pattern's point in the first view's pattern: every other view lies in the same plane, rotated and
/// shifted.
cv::Vec3d turned(const Eigen::VectorXd& parameters, std::size_t view, cv::Point2d at) {
  if (view == 0) return {at.x, at.y, 0.0};
  const Eigen::Index first = first_of(view);
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
  Eigen::VectorXd parameters(parameters_of(views.size()));
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
    const Eigen::Index at = first_of(k);
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

/// Gauss-Newton steps from a start that is already good (solvePnP's), by QR. The damping divides the step, and doubles
/// if the cost does not decrease.
Eigen::VectorXd fit_poses(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m,
                          const Eigen::VectorXd& start) {
  struct Point {
    Eigen::VectorXd parameters;
    Eigen::VectorXd step;  // from here, undivided; empty until it is asked for
  };
  base::FitOptions options;
  options.most_iterations = 100;
  options.damping_start = options.damping_least = 1.0;
  options.damping_most = 1e4;
  options.lower = 0.0;
  options.raise = 2.0;
  const auto try_step = [&](Point& here, double damping) {
    if (here.step.size() == 0) {
      here.step = base::least_squares(jacobian_of(camera, views, square_m, here.parameters),
                                      -residuals_of(camera, views, square_m, here.parameters));
    }
    base::FitTrial<Point> trial;
    trial.point = Point{here.parameters + 1.0 / damping * here.step, {}};
    trial.cost = residuals_of(camera, views, square_m, trial.point->parameters).squaredNorm();
    trial.is_small = here.step.lpNorm<Eigen::Infinity>() < 1e-11;  // radians and metres
    return trial;
  };
  Point here{start, {}};
  base::levenberg_marquardt(here, residuals_of(camera, views, square_m, start).squaredNorm(), options, try_step);
  return here.parameters;
}

Eigen::VectorXd pose_parameters(const PlanePose& pose) {
  cv::Vec3d turn;
  cv::Rodrigues(pose.rotation, turn);
  Eigen::VectorXd parameters(kOfPose);
  for (int i = 0; i < 3; ++i) {
    parameters[i] = turn[i];
    parameters[3 + i] = pose.shift[i];
  }
  return parameters;
}

}  // namespace

std::optional<cv::Point2d> meet_plane(const CameraModel& camera, const PlanePose& pose, cv::Point2d pixel, double z_m) {
  const auto normalised = camera.to_normalised(pixel);
  if (!normalised) return std::nullopt;
  const cv::Vec3d origin = pose.rotation.t() * (-pose.shift);
  const cv::Vec3d ray = pose.rotation.t() * cv::Vec3d(normalised->x, normalised->y, 1.0);
  if (ray[2] == 0.0) return std::nullopt;
  const double reach = (z_m - origin[2]) / ray[2];
  if (!(reach > 0.0)) return std::nullopt;
  return cv::Point2d(origin[0] + reach * ray[0], origin[1] + reach * ray[1]);
}

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
    fit.in_plane.push_back(k == 0 ? Eigen::Vector3d::Zero().eval() : parameters.segment<kOfView>(first_of(k)).eval());
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

std::optional<PlaneViewsDisagree> disagreement(const PlaneFit& fit, std::size_t views, const CornerNoise& noise,
                                               const std::string& group) {
  constexpr double kLeastRmsRatio = 3.0, kLeastOffPx = 0.05;
  // Of one coordinate; every view's pose takes its share out of the residuals, in the plane as in the camera's fit.
  const double expected_px = std::hypot(noise.white_px, noise.correlated_px);
  if (fit.rms_px <= std::max(kLeastOffPx, kLeastRmsRatio * expected_px)) return {};
  return PlaneViewsDisagree{group, fit.rms_px, expected_px, views};
}

PlanePose refit_pose(const CameraModel& camera, const std::vector<BoardCorners>& views, double square_m,
                     const PlaneFit& start) {
  Eigen::VectorXd parameters(parameters_of(views.size()));
  parameters.head<kOfPose>() = pose_parameters(start.pose);
  for (std::size_t k = 1; k < views.size(); ++k) parameters.segment<kOfView>(first_of(k)) = start.in_plane[k];
  return pose_from(fit_poses(camera, views, square_m, parameters));
}

PlanePose moved(const PlanePose& pose, const Eigen::Matrix<double, 6, 1>& change) {
  return pose_from(pose_parameters(pose) + change);
}

}  // namespace glidelab::core
