#include "core/pictures/camera/camera_model.h"

#include <cmath>

namespace glidelab::core {
namespace {

constexpr int kMostNewtonSteps = 40;
constexpr double kTolerancePx = 1e-10;  // a double carries 1e-13 px at 1000 px

struct Distorted {
  cv::Point2d at;
  cv::Matx22d jacobian;  // d(x', y') / d(x, y)
};

/// A mapping along the radius alone: `at_radius` = r'/r, `slope` = dr'/dr.
Distorted along_radius(cv::Point2d n, double at_radius, double slope) {
  const double r2 = n.x * n.x + n.y * n.y;
  const double bend = r2 > 0.0 ? (slope - at_radius) / r2 : 0.0;
  Distorted out;
  out.at = at_radius * n;
  out.jacobian = {at_radius + bend * n.x * n.x, bend * n.x * n.y, bend * n.x * n.y, at_radius + bend * n.y * n.y};
  return out;
}

Distorted fisheye(const std::array<double, 5>& d, cv::Point2d n) {
  const double r = std::hypot(n.x, n.y);
  // On the axis the image is that of a pinhole, up to r^2.
  if (r < 1e-8) return along_radius(n, 1.0, 1.0);
  const double theta = std::atan(r);
  const double t2 = theta * theta;
  const double bent = theta * (1.0 + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3]))));
  const double slope = 1.0 + t2 * (3.0 * d[0] + t2 * (5.0 * d[1] + t2 * (7.0 * d[2] + t2 * 9.0 * d[3])));
  return along_radius(n, bent / r, slope / (1.0 + r * r));
}

Distorted brown_conrady(const std::array<double, 5>& d, cv::Point2d n) {
  const auto [k1, k2, p1, p2, k3] = d;
  const double r2 = n.x * n.x + n.y * n.y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double radial_slope = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);  // d radial / d r2
  Distorted out;
  out.at.x = n.x * radial + 2.0 * p1 * n.x * n.y + p2 * (r2 + 2.0 * n.x * n.x);
  out.at.y = n.y * radial + p1 * (r2 + 2.0 * n.y * n.y) + 2.0 * p2 * n.x * n.y;
  const double mixed = 2.0 * n.x * n.y * radial_slope + 2.0 * p1 * n.x + 2.0 * p2 * n.y;
  out.jacobian(0, 0) = radial + 2.0 * n.x * n.x * radial_slope + 2.0 * p1 * n.y + 6.0 * p2 * n.x;
  out.jacobian(0, 1) = mixed;
  out.jacobian(1, 0) = mixed;
  out.jacobian(1, 1) = radial + 2.0 * n.y * n.y * radial_slope + 6.0 * p1 * n.y + 2.0 * p2 * n.x;
  return out;
}

Distorted distort(const CameraModel& camera, cv::Point2d n) {
  return camera.lens == LensKind::fisheye ? fisheye(camera.distortion, n) : brown_conrady(camera.distortion, n);
}

/// The start: a fisheye's undistorted radius grows as a tangent.
cv::Point2d start_from(LensKind lens, cv::Point2d distorted) {
  const double angle = std::hypot(distorted.x, distorted.y);
  if (lens != LensKind::fisheye || angle < 1e-8) return distorted;
  constexpr double kWidest = 1.4;  // rad; Newton's method finds on from there
  return distorted * (std::tan(std::min(angle, kWidest)) / angle);
}

}  // namespace

CameraModel CameraModel::moved(const Eigen::Matrix<double, 9, 1>& change) const {
  CameraModel camera = *this;
  camera.fx += change[0];
  camera.fy += change[1];
  camera.cx += change[2];
  camera.cy += change[3];
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    camera.distortion[i] += change[4 + static_cast<Eigen::Index>(i)];
  }
  return camera;
}

cv::Point2d CameraModel::to_pixel(cv::Point2d normalised) const {
  const Distorted distorted = distort(*this, normalised);
  return {fx * distorted.at.x + cx, fy * distorted.at.y + cy};
}

std::optional<cv::Point2d> CameraModel::to_normalised(cv::Point2d pixel) const {
  const cv::Point2d wanted((pixel.x - cx) / fx, (pixel.y - cy) / fy);
  const double tolerance = kTolerancePx / std::max(fx, fy);
  cv::Point2d here = start_from(lens, wanted);
  double error = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostNewtonSteps; ++i) {
    const Distorted distorted = distort(*this, here);
    const cv::Point2d off = distorted.at - wanted;
    error = std::sqrt(off.dot(off));
    // The branch that contains the axis: there the distortion keeps its orientation.
    const double determinant = cv::determinant(distorted.jacobian);
    if (!(determinant > 0.0) || !std::isfinite(error)) return std::nullopt;
    if (error < tolerance) return here;
    const cv::Vec2d step = distorted.jacobian.inv() * cv::Vec2d(off.x, off.y);
    // A long step is shortened, so that the iteration does not jump over the fold.
    const double length = std::sqrt(step.dot(step));
    const double share = std::min(1.0, 0.3 / length);
    here -= cv::Point2d(share * step[0], share * step[1]);
  }
  if (error < 1e3 * tolerance) return here;
  return std::nullopt;
}

}  // namespace glidelab::core
