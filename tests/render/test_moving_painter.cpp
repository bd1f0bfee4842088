#include "render/moving_painter.h"

#include <array>
#include <cmath>

#include "catch.h"
#include "render/sphere_image.h"

using namespace glidelab::render;

namespace {

Camera paper_like_camera(const BrownConrady& lens) {
  Camera camera;
  camera.width_px = 800;
  camera.height_px = 600;
  camera.focal_px = {1200.0, 1203.0};
  camera.center_px = {405.3, 294.8};
  camera.lens = lens;
  camera.X_WC = look_at({0.12, 0.18, 2.4}, {0.01, -0.02, 0.0}, 0.02);
  return camera;
}

constexpr BrownConrady kNoLens{};
constexpr BrownConrady kBarrel{-0.22, 0.09, -0.01, 0.0006, -0.0009};
constexpr BrownConrady kPincushion{0.18, 0.05, 0.0, -0.001, 0.0007};

/// A marker whose centre appears near `pixel`, at `depth` before the camera, of about `radius_px`.
MovingBody marker_at(const Camera& camera, const Eigen::Vector2d& pixel, double depth_m, double radius_px) {
  MovingBody body;
  const Eigen::Vector2d ray = undistorted_at(camera, pixel).value();
  body.direction_W = Eigen::Vector3d(0.99, -0.1, 0.0).normalized();
  body.marker =
      MarkerSphere{camera.X_WC * (depth_m * ray.homogeneous()), radius_px * depth_m / camera.focal_px.x(), 1.0};
  return body;
}

struct Moments {
  double area = 0.0;
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  void add(double value, int u, int v) {
    area += value;
    centroid += value * Eigen::Vector2d(u, v);
  }
  void finish() { centroid /= area; }
};

Moments moments_of(const MovingLayer& layer) {
  Moments moments;
  for (int y = 0; y < layer.rect.height; ++y) {
    for (int x = 0; x < layer.rect.width; ++x) {
      moments.add(static_cast<double>(layer.radiance[static_cast<std::size_t>(y) * layer.rect.width + x]),
                  layer.rect.x + x, layer.rect.y + y);
    }
  }
  moments.finish();
  return moments;
}

/// The same from nothing but rays: n x n of them a pixel, each tested against the sphere in double.
Moments moments_by_rays(const Camera& camera, const MarkerSphere& marker, const PixelRect& rect, int n) {
  const Eigen::Vector3d c = camera.X_WC.inverse() * marker.center_W;
  Moments moments;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      int hits = 0;
      for (int i = 0; i < n * n; ++i) {
        const Eigen::Vector2d pixel(x - 0.5 + (i % n + 0.5) / n, y - 0.5 + (i / n + 0.5) / n);
        const Eigen::Vector3d ray = undistorted_at(camera, pixel).value().homogeneous().normalized();
        hits += ray.cross(c).norm() < marker.radius_m ? 1 : 0;
      }
      moments.add(hits / static_cast<double>(n * n), x, y);
    }
  }
  moments.finish();
  return moments;
}

const std::array<double, 1> kStill{0.0};

}  // namespace

TEST_CASE("The photometric centre of a still marker is the centroid of its exact picture, anywhere") {
  // Square pixels sample the disc: Poisson's summation gives their centroid an error of |J1(2 pi R)| / (pi² R) a
  // direction, at most sqrt(2) 0.16 / 40 = 0.0057 px at R = 4. The renderer's own error is an order below (next test).
  double worst = 0.0;
  double worst_area = 0.0;
  for (const BrownConrady& lens : {kNoLens, kBarrel, kPincushion}) {
    const Camera camera = paper_like_camera(lens);
    REQUIRE_FALSE(why_not_one_to_one(camera));
    const RayTable rays = make_ray_table(camera);
    for (const double radius_px : {4.0, 5.3, 7.7, 12.0}) {
      for (const Eigen::Vector2d& around :
           {Eigen::Vector2d(20, 20), Eigen::Vector2d(780, 20), Eigen::Vector2d(20, 580), Eigen::Vector2d(780, 580),
            Eigen::Vector2d(400, 300), Eigen::Vector2d(600, 150)}) {
        for (int phase = 0; phase < 8; ++phase) {
          const Eigen::Vector2d pixel = around + Eigen::Vector2d(0.137 * phase, std::fmod(0.391 * phase, 1.0));
          const MovingBody body = marker_at(camera, pixel, 2.4, radius_px);
          const Moments seen = moments_of(paint(camera, rays, body, kStill));
          const AreaMoments exact = picture_of(
              camera, image_of_sphere(camera.X_WC.inverse() * body.marker->center_W, body.marker->radius_m).value());
          worst = std::max(worst, (seen.centroid - exact.centroid_px).norm());
          worst_area = std::max(worst_area, std::abs(seen.area / exact.area_px - 1.0));
        }
      }
    }
  }
  CHECK(worst < 0.006);
  CHECK(worst_area < 3e-4);
}

TEST_CASE("A marker's pixels agree in their moments with rays cast one by one") {
  // 48 x 48 rays a pixel: the centroid's own error is 48^-1.5 / R^0.5 px or so, 1.5e-3 px at most.
  const Camera camera = paper_like_camera(kBarrel);
  const RayTable rays = make_ray_table(camera);
  double worst = 0.0;
  for (const double radius_px : {2.5, 4.0, 5.3, 12.0}) {
    for (int phase = 0; phase < 4; ++phase) {
      const MovingBody body = marker_at(camera, {770.0 + 0.237 * phase, 25.0 + 0.391 * phase}, 2.4, radius_px);
      const MovingLayer layer = paint(camera, rays, body, kStill);
      const Moments seen = moments_of(layer);
      const Moments cast = moments_by_rays(camera, *body.marker, layer.rect, 48);
      worst = std::max(worst, (seen.centroid - cast.centroid).norm());
    }
  }
  CHECK(worst < 0.0015);
}
