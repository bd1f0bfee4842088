/// A camera of the tests' own, written apart from core/: pose, pinhole, Brown's distortion, forwards only.
#pragma once

#include <opencv2/core.hpp>

#include <cmath>
#include <vector>

#include "core/pictures/board/chessboard.h"

namespace glidelab::tests {

struct KnownCamera {
  double fx = 830.0, fy = 828.0, cx = 403.7, cy = 296.2;
  double k1 = -0.21, k2 = 0.07, p1 = 4e-4, p2 = -3e-4, k3 = 0.0;
  cv::Size size{800, 600};

  cv::Point2d project(cv::Vec3d c) const {
    const double x = c[0] / c[2], y = c[1] / c[2];
    const double r = std::hypot(x, y);
    const double stretch = 1.0 + k1 * std::pow(r, 2) + k2 * std::pow(r, 4) + k3 * std::pow(r, 6);
    const double xd = x * stretch + p1 * 2.0 * x * y + p2 * (3.0 * x * x + y * y);
    const double yd = y * stretch + p2 * 2.0 * x * y + p1 * (x * x + 3.0 * y * y);
    return {fx * xd + cx, fy * yd + cy};
  }
};

/// A plane's frame before the camera: origin, and unit vectors along X and Y in the camera's frame.
struct KnownPlane {
  cv::Vec3d origin, x, y;
  cv::Vec3d at(double px, double py, double pz = 0.0) const { return origin + px * x + py * y + pz * x.cross(y); }
};

/// Turned about the camera's axes by (ax, ay, az) [rad], in this order, with the point (mx, my) of the plane at
/// `middle`.
inline KnownPlane known_plane(cv::Vec3d middle, double ax, double ay, double az, double mx, double my) {
  const auto turn = [&](cv::Vec3d p) {
    p = {p[0], p[1] * std::cos(ax) - p[2] * std::sin(ax), p[1] * std::sin(ax) + p[2] * std::cos(ax)};
    p = {p[0] * std::cos(ay) + p[2] * std::sin(ay), p[1], -p[0] * std::sin(ay) + p[2] * std::cos(ay)};
    return cv::Vec3d(p[0] * std::cos(az) - p[1] * std::sin(az), p[0] * std::sin(az) + p[1] * std::cos(az), p[2]);
  };
  KnownPlane plane;
  plane.x = turn({1, 0, 0});
  plane.y = turn({0, 1, 0});
  plane.origin = middle - mx * plane.x - my * plane.y;
  return plane;
}

/// The corners of a 9 x 6 board in the plane (its first inner corner at (from.x, from.y)), with Gaussian noise.
inline core::BoardCorners known_corners(const KnownCamera& camera, const KnownPlane& plane, double square_m,
                                        double noise_px, cv::RNG& random, cv::Point2d from = {0.0, 0.0},
                                        double turn = 0.0) {
  core::BoardCorners corners;
  corners.grid = {9, 6};
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 9; ++i) {
      const double x = i * square_m, y = j * square_m;
      const cv::Point2d p = camera.project(
          plane.at(from.x + std::cos(turn) * x - std::sin(turn) * y, from.y + std::sin(turn) * x + std::cos(turn) * y));
      corners.points.emplace_back(p.x + random.gaussian(noise_px), p.y + random.gaussian(noise_px));
      corners.sd_px.push_back(noise_px);
    }
  }
  return corners;
}

/// A dozen poses that fill the image, as a person holds a board of 40 mm squares.
inline core::BoardViews known_views(const KnownCamera& camera, double noise_px, cv::RNG& random) {
  core::BoardViews boards;
  boards.image_size = camera.size;
  int k = 0;
  for (const double ay : {-0.5, -0.15, 0.2, 0.55}) {
    for (const double ax : {-0.4, 0.05, 0.45}) {
      const cv::Vec3d middle(0.12 * ((k % 4) - 1.5), 0.09 * ((k / 4) - 1.0), 0.62 + 0.03 * (k % 5));
      const KnownPlane plane = known_plane(middle, ax, ay, 0.1 * (k % 3) - 0.1, 0.16, 0.10);
      boards.views.push_back(
          {"view-" + std::to_string(k) + ".png", known_corners(camera, plane, 0.04, noise_px, random)});
      ++k;
    }
  }
  return boards;
}

}  // namespace glidelab::tests
