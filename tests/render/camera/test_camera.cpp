#include "render/camera/camera.h"

#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>

#include "render/camera/optics.h"
#include "tests/catch.h"

using namespace glidelab::render;

namespace {

Camera some_camera(const Lens& lens) {
  Camera camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.focal_px = {700.0, 705.0};
  camera.center_px = {322.5, 236.25};
  camera.lens = lens;
  camera.X_WC = look_at({0.4, 0.3, 2.0}, {0.05, -0.1, 0.0}, 0.1);
  return camera;
}

Lens rational_lens() {
  Lens lens{0.12, -0.31, 0.05, 0.0007, -0.0004};
  lens.k4 = 0.45;
  lens.k5 = -0.2;
  lens.k6 = 0.08;
  lens.model = LensModel::rational;
  return lens;
}

Lens fisheye_lens() {
  Lens lens{-0.03, 0.012, -0.008, 0.0, 0.0};
  lens.k4 = 0.0015;
  lens.model = LensModel::fisheye;
  return lens;
}

const std::array<Lens, 6> kLenses = {{{},
                                      {-0.3, 0.12, -0.02, 0.001, -0.002},
                                      {0.25, 0.1, 0.0, -0.002, 0.001},
                                      {-0.15, 0.0, 0.0, 0.0, 0.0},
                                      rational_lens(),
                                      fisheye_lens()}};

}  // namespace

TEST_CASE("A pixel's ray leads back to the pixel, over the whole image") {
  // Newton's method ends within 1e-14 of the focal length; the mapping magnifies by less than 10.
  for (const Lens& lens : kLenses) {
    const Camera camera = some_camera(lens);
    for (double u = -0.5; u <= 639.5; u += 40.0) {
      for (double v = -0.5; v <= 479.5; v += 40.0) {
        const Eigen::Vector2d ray = undistorted_at(camera, {u, v}).value();
        const Eigen::Vector3d far_W = camera.X_WC * (3.7 * ray.homogeneous());
        CHECK((project(camera, far_W).value() - Eigen::Vector2d(u, v)).norm() < 1e-10);
      }
    }
  }
}

TEST_CASE("Points project as OpenCV's projectPoints and fisheye::projectPoints say") {
  // Both are in double: 1e-9 px is some thousand roundings of a value of 640.
  for (const Lens& lens : kLenses) {
    const Camera camera = some_camera(lens);
    const Eigen::Isometry3d X_CW = camera.X_WC.inverse();
    cv::Matx33d rotation;
    for (int i = 0; i < 9; ++i) rotation(i / 3, i % 3) = X_CW.linear()(i / 3, i % 3);
    cv::Vec3d rotation_vector;
    cv::Rodrigues(rotation, rotation_vector);
    const cv::Vec3d translation(X_CW.translation().x(), X_CW.translation().y(), X_CW.translation().z());
    const cv::Matx33d matrix(camera.focal_px.x(), 0, camera.center_px.x(), 0, camera.focal_px.y(), camera.center_px.y(),
                             0, 0, 1);
    const std::vector<double> coefficients{lens.k1, lens.k2, lens.p1, lens.p2, lens.k3, lens.k4, lens.k5, lens.k6};
    std::vector<cv::Point3d> points;
    for (double x = -0.6; x <= 0.6; x += 0.15) {
      for (double y = -0.4; y <= 0.4; y += 0.1) points.emplace_back(x, y, 0.3 * x - 0.2 * y);
    }
    std::vector<cv::Point2d> pixels;
    if (lens.model == LensModel::fisheye) {
      cv::fisheye::projectPoints(points, pixels, rotation_vector, translation, matrix,
                                 cv::Vec4d(lens.k1, lens.k2, lens.k3, lens.k4));
    } else {
      cv::projectPoints(points, rotation_vector, translation, matrix, coefficients, pixels);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto pixel = project(camera, {points[i].x, points[i].y, points[i].z});
      REQUIRE(pixel);
      CHECK((*pixel - Eigen::Vector2d(pixels[i].x, pixels[i].y)).norm() < 1e-9);
    }
  }
}

TEST_CASE("The distortion's Jacobian is the limit of its differences") {
  // Central differences with h = 1e-5 err by h² f'''/6 ~ 1e-10 and by rounding, 1e-16 / 1e-5.
  constexpr double kStep = 1e-5;
  for (const Lens& lens : kLenses) {
    const Eigen::Vector2d at(0.31, -0.22);
    const Eigen::Matrix2d jacobian = distortion_jacobian(lens, at);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector2d difference = (distort(lens, at + step) - distort(lens, at - step)) / (2.0 * kStep);
      CHECK((jacobian.col(axis) - difference).norm() < 1e-8);
    }
  }
}

TEST_CASE("A barrel lens with k1 alone folds at 1/sqrt(-3 k1), and one without barrel never") {
  // r (1 + k1 r²) has its maximum there; bisection ends within 1e-15 of the square.
  CHECK(std::abs(fold_radius({-0.2, 0, 0, 0, 0}) - 1.0 / std::sqrt(0.6)) < 1e-12);
  CHECK(std::isinf(fold_radius({0.2, 0.1, 0.0, 0, 0})));
  CHECK(std::isinf(fold_radius({})));
  // 1 + 3 k1 s + 5 k2 s² with k1 = -0.5, k2 = 0.1: s = (1.5 - sqrt(2.25 - 2)) / 1 = 1.
  CHECK(std::abs(fold_radius({-0.5, 0.1, 0, 0, 0}) - 1.0) < 1e-12);
  // A dip that stays above zero does not fold: 1 - 1.5 s + 1 s², discriminant 2.25 - 4 < 0.
  CHECK(std::isinf(fold_radius({-0.5, 0.2, 0, 0, 0})));
  // 1 + 7 k3 s³ with k3 = -1/7: s = 1.
  CHECK(std::abs(fold_radius({0, 0, -1.0 / 7.0, 0, 0}) - 1.0) < 1e-12);
}

TEST_CASE("A rational lens folds where its radius stops growing or has a pole, a fisheye where its angle does") {
  // r / (1 + s) grows until s = 1; r / (1 - s/4) has a pole at s = 4; the companion's eigenvalues are polished by
  // bisection to the last bits.
  Lens lens;
  lens.model = LensModel::rational;
  lens.k4 = 1.0;
  CHECK(std::abs(fold_radius(lens) - 1.0) < 1e-12);
  lens.k4 = -0.25;
  CHECK(std::abs(fold_radius(lens) - 2.0) < 1e-12);
  // With the denominator 1 it is the polynomial.
  lens = {-0.5, 0.1, 0, 0, 0};
  lens.model = LensModel::rational;
  CHECK(std::abs(fold_radius(lens) - 1.0) < 1e-12);
  // theta (1 - theta²/3) grows until theta = 1.
  lens = {-1.0 / 3.0, 0, 0, 0, 0};
  lens.model = LensModel::fisheye;
  CHECK(std::abs(fold_radius(lens) - std::tan(1.0)) < 1e-12);
  lens.k1 = -0.1;  // until theta = 1.83, beyond a right angle
  CHECK(std::isinf(fold_radius(lens)));
}

TEST_CASE("A fisheye's rays come back from far off its axis") {
  // At 80 degrees tan is 5.7 and its slope 33: the angle's 1e-16 become some 1e-14.
  Lens lens = fisheye_lens();
  lens.k4 = 0.0;
  for (const double degrees : {1e-6, 0.01, 1.0, 30.0, 60.0, 80.0}) {
    const double radius = std::tan(degrees * std::numbers::pi / 180.0);
    const Eigen::Vector2d at(0.6 * radius, -0.8 * radius);
    const auto back = undistort(lens, distort(lens, at));
    CAPTURE(degrees);
    REQUIRE(back);
    CHECK((*back - at).norm() < 1e-13 * (1.0 + 10.0 * radius * radius));
  }
}

TEST_CASE("Beyond the fold nothing is projected, though the formula would give a pixel") {
  Camera camera = some_camera({-0.2, 0, 0, 0, 0});
  // r = 1.5 is beyond 1.29; the formula maps it to 0.825, inside what r = 1.29 reaches (0.86).
  CHECK_FALSE(pixel_of(camera, {1.5, 0.0}));
  CHECK(pixel_of(camera, {1.2, 0.0}));
}

TEST_CASE("A lens is one to one over the image until it folds within it") {
  CHECK_FALSE(why_not_one_to_one(some_camera(kLenses[1])));
  CHECK_FALSE(why_not_one_to_one(some_camera(kLenses[2])));
  // The corner is at 0.57 focal lengths; r (1 - r²) reaches 0.385 at most.
  const auto why = why_not_one_to_one(some_camera({-1.0, 0, 0, 0, 0}));
  REQUIRE(why);
  CHECK(why->find("folds") != std::string::npos);
}

TEST_CASE("A camera looks at its target, right side up, and roll turns it clockwise") {
  Camera camera = some_camera({});
  CHECK((project(camera, {0.05, -0.1, 0.0}).value() - camera.center_px).norm() < 1e-9);
  camera.X_WC = look_at({0.0, 0.0, 2.0}, {0.0, 0.0, 0.0}, 0.0);
  CHECK(std::abs(camera.X_WC.linear().determinant() - 1.0) < 1e-12);
  CHECK(project(camera, {0.1, 0.0, 0.0})->x() > camera.center_px.x());
  CHECK(project(camera, {0.0, 0.1, 0.0})->y() < camera.center_px.y());  // up in the world is up in the image
  // A camera that is turned clockwise sees the world turned anticlockwise: what was to the right moves up.
  camera.X_WC = look_at({0.0, 0.0, 2.0}, {0.0, 0.0, 0.0}, 0.1);
  CHECK(project(camera, {0.1, 0.0, 0.0})->y() < camera.center_px.y());
  CHECK_FALSE(project(camera, {0.0, 0.0, 2.5}));
}

TEST_CASE("The ray table holds each pixel's ray and its derivative") {
  // Single precision: 2^-25 of 1/2; the derivative against central differences over a pixel, whose error is a sixth of
  // the third derivative, some 1e-9.
  const Camera camera = some_camera(kLenses[1]);
  const RayTable table = make_ray_table(camera);
  REQUIRE(table.x_y_dxdu_dxdv.size() == 640u * 480u * 4u);
  for (const auto& pixel : {std::pair{0, 0}, {639, 0}, {0, 479}, {639, 479}, {320, 100}}) {
    const int u = pixel.first, v = pixel.second;
    const std::size_t at = static_cast<std::size_t>(v) * 640 + static_cast<std::size_t>(u);
    const auto ray = [&](double du, double dv) { return undistorted_at(camera, {u + du, v + dv}).value(); };
    const Eigen::Vector2d along_u = ray(0.5, 0) - ray(-0.5, 0);
    const Eigen::Vector2d along_v = ray(0, 0.5) - ray(0, -0.5);
    CHECK(std::abs(static_cast<double>(table.x_y_dxdu_dxdv[4 * at]) - ray(0, 0).x()) < 3e-8);
    CHECK(std::abs(static_cast<double>(table.x_y_dxdu_dxdv[4 * at + 1]) - ray(0, 0).y()) < 3e-8);
    CHECK(std::abs(static_cast<double>(table.x_y_dxdu_dxdv[4 * at + 2]) - along_u.x()) < 1e-8);
    CHECK(std::abs(static_cast<double>(table.x_y_dxdu_dxdv[4 * at + 3]) - along_v.x()) < 1e-8);
    CHECK(std::abs(static_cast<double>(table.dydu_dydv[2 * at]) - along_u.y()) < 1e-8);
    CHECK(std::abs(static_cast<double>(table.dydu_dydv[2 * at + 1]) - along_v.y()) < 1e-8);
  }
}
