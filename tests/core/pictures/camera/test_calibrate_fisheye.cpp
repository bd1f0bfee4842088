#include "core/pictures/camera/calibrate.h"

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "tests/catch.h"
#include "tests/core/known_camera.h"

using namespace glidelab;

namespace {

/// A wide fisheye: 400 px over 1.05 rad.
core::CameraModel wide_camera() {
  return {380.0, 381.0, 402.4, 297.1, {0.03, -0.012, 0.006, 0.0, 0.0}, {800, 600}, core::LensKind::fisheye};
}

/// A dozen poses that fill the wide image; projected by OpenCV, with noise.
core::BoardViews wide_views(const core::CameraModel& camera, double noise_px, cv::RNG& random) {
  const cv::Matx33d matrix(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
  const cv::Vec4d lens(camera.distortion[0], camera.distortion[1], camera.distortion[2], camera.distortion[3]);
  core::BoardViews boards;
  boards.image_size = camera.size;
  int k = 0;
  for (const double ay : {-0.5, -0.15, 0.2, 0.55}) {
    for (const double ax : {-0.4, 0.05, 0.45}) {
      const cv::Vec3d middle(0.17 * ((k % 4) - 1.5), 0.13 * ((k / 4) - 1.0), 0.34 + 0.02 * (k % 5));
      const tests::KnownPlane plane = tests::known_plane(middle, ax, ay, 0.1 * (k % 3) - 0.1, 0.16, 0.10);
      std::vector<cv::Point3d> points;
      for (int j = 0; j < 6; ++j) {
        for (int i = 0; i < 9; ++i) points.emplace_back(cv::Point3d(plane.at(i * 0.04, j * 0.04)));
      }
      std::vector<cv::Point2d> pixels;
      cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), matrix, lens);
      core::BoardCorners corners;
      corners.grid = {9, 6};
      for (const cv::Point2d& p : pixels) {
        corners.points.emplace_back(p.x + random.gaussian(noise_px), p.y + random.gaussian(noise_px));
        corners.sd_px.push_back(noise_px);
      }
      boards.views.push_back({"view-" + std::to_string(k++) + ".png", corners});
    }
  }
  return boards;
}

}  // namespace

TEST_CASE("a fisheye projects as OpenCV's does, and undoing it is its inverse to 1e-9 px up to 80 degrees") {
  const core::CameraModel camera = wide_camera();
  const cv::Matx33d matrix(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
  const cv::Vec4d lens(camera.distortion[0], camera.distortion[1], camera.distortion[2], camera.distortion[3]);
  for (int degrees = 0; degrees <= 80; degrees += 5) {
    for (int turn = 0; turn < 8; ++turn) {
      const double r = std::tan(degrees * CV_PI / 180.0);
      const cv::Point2d n(r * std::cos(0.25 * CV_PI * turn + 0.1), r * std::sin(0.25 * CV_PI * turn + 0.1));
      std::vector<cv::Point2d> pixel;
      cv::fisheye::projectPoints(std::vector<cv::Point3d>{{n.x, n.y, 1.0}}, pixel, cv::Vec3d(), cv::Vec3d(), matrix,
                                 lens);
      CAPTURE(degrees, turn);
      // Two ways to round the same numbers: 1e-12 of 600 px.
      CHECK(cv::norm(camera.to_pixel(n) - pixel.front()) < 1e-9);
      const auto back = camera.to_normalised(camera.to_pixel(n));
      REQUIRE(back);
      CHECK(cv::norm(camera.to_pixel(*back) - camera.to_pixel(n)) < 1e-9);
    }
  }
}

TEST_CASE("a known fisheye is recovered from noisy corners within its stated uncertainty") {
  const core::CameraModel truth = wide_camera();
  cv::RNG random(5);
  const std::optional<core::Calibration> fit = core::calibrate_fisheye(wide_views(truth, 0.02, random), 0.04);
  REQUIRE(fit);
  const core::Calibration& found = *fit;
  CHECK(found.camera.lens == core::LensKind::fisheye);
  CHECK(found.views_used == 12);
  // The rms distance of an error with sd 0.02 in each coordinate over 648 corners, of which 80 terms take their share:
  // 0.02 sqrt(2) sqrt(1 - 80/1296) +- 2 %.
  CHECK(std::abs(found.rms_px / (0.02 * std::sqrt(2.0) * std::sqrt(1.0 - 80.0 / 1296.0)) - 1.0) < 0.08);
  // Over the image: the modelled direction of each pixel against the true one, in pixels. The camera's own
  // covariance says how far it may be off; four standard deviations, the corners' being large where no board was seen.
  for (int v = 30; v < 600; v += 90) {
    for (int u = 40; u < 800; u += 90) {
      const auto ray = truth.to_normalised(cv::Point2d(u, v));
      REQUIRE(ray);
      Eigen::Matrix<double, 2, 9> slope;
      for (int k = 0; k < 9; ++k) {
        Eigen::Matrix<double, 9, 1> step = Eigen::Matrix<double, 9, 1>::Zero();
        step[k] = 1e-5;
        const cv::Point2d moved = (found.camera.moved(step).to_pixel(*ray) - found.camera.to_pixel(*ray)) * 1e5;
        slope.col(k) << moved.x, moved.y;
      }
      const Eigen::Matrix2d covariance = slope * found.covariance * slope.transpose();
      const cv::Point2d off = found.camera.to_pixel(*ray) - cv::Point2d(u, v);
      CAPTURE(u, v, off, covariance(0, 0), covariance(1, 1));
      CHECK(std::abs(off.x) < 4.0 * std::sqrt(covariance(0, 0)));
      CHECK(std::abs(off.y) < 4.0 * std::sqrt(covariance(1, 1)));
    }
  }
}

TEST_CASE("a fisheye is found out from its images, and a Brown-Conrady lens is not taken for one") {
  cv::RNG random(7);
  const core::BoardViews wide = wide_views(wide_camera(), 0.02, random);
  CHECK(core::calibrate_any_lens(wide, 0.04).camera.lens == core::LensKind::fisheye);
  CHECK(core::calibrate_camera(wide, 0.04).camera.lens == core::LensKind::brown_conrady);
  const core::BoardViews narrow = tests::known_views(tests::KnownCamera{}, 0.02, random);
  CHECK(core::calibrate_any_lens(narrow, 0.04).camera.lens == core::LensKind::brown_conrady);
}

TEST_CASE("a fisheye seen in the middle of the image alone holds at its edge, for its few terms are preferred") {
  const core::CameraModel camera{400.0, 400.0, 319.5, 239.5, {}, {640, 480}, core::LensKind::fisheye};
  cv::RNG random(11);
  core::BoardViews boards;
  boards.image_size = camera.size;
  for (int k = 0; k < 10; ++k) {
    const cv::Vec3d middle(0.06 * (k % 5 - 2), 0.05 * (k % 3 - 1), 0.75 + 0.02 * (k % 4));
    const tests::KnownPlane plane =
        tests::known_plane(middle, 0.35 * std::sin(2.0 * k), 0.4 * std::cos(3.0 * k), 0.3 * k, 0.16, 0.10);
    core::BoardCorners corners;
    corners.grid = {9, 6};
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 9; ++i) {
        const cv::Vec3d at = plane.at(i * 0.04, j * 0.04);
        const double r = std::hypot(at[0], at[1]), angle = std::atan2(r, at[2]);  // equidistant
        corners.points.emplace_back(319.5 + 400.0 * angle * at[0] / r + random.gaussian(0.01),
                                    239.5 + 400.0 * angle * at[1] / r + random.gaussian(0.01));
        corners.sd_px.push_back(0.01);
      }
    }
    boards.views.push_back({"view-" + std::to_string(k) + ".png", corners});
  }
  const core::Calibration found = core::calibrate_any_lens(boards, 0.04);
  CHECK(found.camera.lens == core::LensKind::fisheye);
  const double angle = 35.0 * CV_PI / 180.0;  // the pattern was seen up to some 25 degrees
  const cv::Point2d edge = found.camera.to_pixel({std::tan(angle), 0.0});
  const double known = std::sqrt(found.covariance(0, 0) * angle * angle + found.covariance(2, 2));
  CHECK(std::abs(edge.x - (319.5 + 400.0 * angle)) < 4.0 * known);
  CHECK(known < 0.15);
  CHECK(found.covariance(4, 4) > 0.0);  // of a term that was left out
}
