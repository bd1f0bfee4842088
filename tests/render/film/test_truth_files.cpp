#include "render/film/truth_files.h"

#include <cmath>
#include <numbers>

#include "tests/catch.h"

using namespace glidelab::render;

TEST_CASE("A sphere on the optical axis is a circle of radius tan(asin(r/D))") {
  const Ellipse ellipse = image_of_sphere({0.0, 0.0, 2.0}, 0.3).value();
  const double radius = std::tan(std::asin(0.15));
  CHECK(ellipse.center.norm() < 1e-15);
  CHECK(std::abs(ellipse.axis_u.norm() - radius) < 1e-14);
  CHECK(std::abs(ellipse.axis_v.norm() - radius) < 1e-14);
}

TEST_CASE("A sphere off the axis is the ellipse between its two extreme rays, whose centre is not the centre's ray") {
  // In the plane of the axis and the centre the extreme rays are at the centre's angle plus and minus asin(r/D).
  const double angle = 0.5;
  const double distance = 1.7;
  const double half = std::asin(0.2 / distance);
  const Ellipse ellipse = image_of_sphere({distance * std::sin(angle), 0.0, distance * std::cos(angle)}, 0.2).value();
  const double near_end = std::tan(angle - half);
  const double far_end = std::tan(angle + half);
  CHECK(std::abs(ellipse.center.x() - 0.5 * (near_end + far_end)) < 1e-14);
  CHECK(std::abs(ellipse.center.y()) < 1e-15);
  CHECK(std::abs(std::max(ellipse.axis_u.norm(), ellipse.axis_v.norm()) - 0.5 * (far_end - near_end)) < 1e-14);
  CHECK(ellipse.center.x() - std::tan(angle) > 1e-3);
}

TEST_CASE("A sphere that reaches the camera's plane has no ellipse") {
  CHECK_FALSE(image_of_sphere({0.0, 0.0, 0.2}, 0.2));
  CHECK_FALSE(image_of_sphere({1.0, 0.0, -2.0}, 0.2));
}

TEST_CASE(
    "Without a lens the image of an ellipse has its area and centre, and with one those of a fine grid of points") {
  Camera camera;
  camera.width_px = 800;
  camera.height_px = 600;
  camera.focal_px = {1000.0, 1010.0};
  camera.center_px = {400.0, 300.0};
  const Ellipse ellipse = image_of_sphere({0.5, -0.35, 2.0}, 0.05).value();
  const double area = std::numbers::pi *
                      std::abs(ellipse.axis_u.x() * ellipse.axis_v.y() - ellipse.axis_u.y() * ellipse.axis_v.x()) *
                      1.01e6;
  AreaMoments moments = image_of(camera, ellipse);
  CHECK(std::abs(moments.area_px / area - 1.0) < 1e-12);
  const Eigen::Vector2d center = ellipse.center.cwiseProduct(camera.focal_px) + camera.center_px;
  CHECK((moments.centroid_px - center).norm() < 1e-10);

  camera.lens = {-0.25, 0.1, 0.02, 0.003, -0.002};
  moments = image_of(camera, ellipse);
  // An independent count: pixels of 1/20 px whose inverse lies in the ellipse. Its border has some 3000 of them, so the
  // centroid errs by sqrt(3000/12) * 0.05 * 25 / area(px) / 20 ~ 1e-3 px at most.
  Eigen::Matrix2d axes;
  axes << ellipse.axis_u, ellipse.axis_v;
  double count = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const int reach = 40 * 20;
  for (int i = -reach; i < reach; ++i) {
    for (int k = -reach; k < reach; ++k) {
      const Eigen::Vector2d pixel = moments.centroid_px + Eigen::Vector2d(i + 0.5, k + 0.5) / 20.0;
      const Eigen::Vector2d ray = undistorted_at(camera, pixel).value();
      if ((axes.inverse() * (ray - ellipse.center)).squaredNorm() > 1.0) continue;
      count += 1.0;
      sum += pixel;
    }
  }
  CHECK((moments.centroid_px - sum / count).norm() < 1e-3);
  CHECK(std::abs(moments.area_px / (count / 400.0) - 1.0) < 1e-4);
}
