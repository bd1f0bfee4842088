#include "render/paint/moving_painter.h"

#include <array>
#include <cmath>

#include "base/errors.h"
#include "render/film/truth_files.h"
#include "tests/catch.h"

using namespace glidelab::render;

namespace {

Camera paper_like_camera(const Lens& lens) {
  Camera camera;
  camera.width_px = 800;
  camera.height_px = 600;
  camera.focal_px = {1200.0, 1203.0};
  camera.center_px = {405.3, 294.8};
  camera.lens = lens;
  camera.X_WC = look_at({0.12, 0.18, 2.4}, {0.01, -0.02, 0.0}, 0.02);
  return camera;
}

constexpr Lens kNoLens{};
constexpr Lens kBarrel{-0.22, 0.09, -0.01, 0.0006, -0.0009};
constexpr Lens kPincushion{0.18, 0.05, 0.0, -0.001, 0.0007};

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

/// The pixels in which the layer holds anything, and one around them: a layer is as large as its tiles.
PixelRect seen_part(const MovingLayer& layer) {
  PixelRect seen;
  for (int y = 0; y < layer.rect.height; ++y) {
    for (int x = 0; x < layer.rect.width; ++x) {
      if (layer.coverage[static_cast<std::size_t>(y) * layer.rect.width + x] == 0.0f) continue;
      seen = united(seen, {layer.rect.x + x - 1, layer.rect.y + y - 1, 3, 3});
    }
  }
  return intersection(seen, layer.rect);
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

TEST_CASE("The photometric centre of a still marker is the centroid of its exact image, anywhere") {
  // Square pixels sample the disc: Poisson's summation gives their centroid an error of |J1(2 pi R)| / (pi² R) a
  // direction, at most sqrt(2) 0.16 / 40 = 0.0057 px at R = 4. The renderer's own error is an order below (next test).
  double worst = 0.0;
  double worst_area = 0.0;
  for (const Lens& lens : {kNoLens, kBarrel, kPincushion}) {
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
          const AreaMoments exact = image_of(
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
      const Moments cast = moments_by_rays(camera, *body.marker, seen_part(layer), 48);
      worst = std::max(worst, (seen.centroid - cast.centroid).norm());
    }
  }
  CHECK(worst < 0.0015);
}

TEST_CASE("A marker that moves is smeared by its displacement, about the middle of it") {
  // The image of a disc that is smeared evenly over L has a variance along the motion that is larger by L²/12 (less
  // L²/(12 n²) for sampling in n equal parts). The centre is that of the middle, up to the change of perspective over
  // the displacement, 1e-4 px.
  const Camera camera = paper_like_camera(kNoLens);
  const RayTable rays = make_ray_table(camera);
  const MovingBody body = marker_at(camera, {402.3, 305.8}, 2.4, 5.0);
  const auto variance_along = [&](const MovingLayer& layer, const Eigen::Vector2d& direction) {
    const Moments moments = moments_of(layer);
    double sum = 0.0;
    for (int y = 0; y < layer.rect.height; ++y) {
      for (int x = 0; x < layer.rect.width; ++x) {
        const double off = direction.dot(Eigen::Vector2d(layer.rect.x + x, layer.rect.y + y) - moments.centroid);
        sum += static_cast<double>(layer.radiance[static_cast<std::size_t>(y) * layer.rect.width + x]) * off * off;
      }
    }
    return sum / moments.area;
  };
  const MovingLayer still = paint(camera, rays, body, kStill);
  const auto pixel_at = [&](double x) { return project(camera, body.marker->center_W + x * body.direction_W).value(); };
  for (const double smear_m : {0.0005, 0.004, 0.020}) {
    const Eigen::Vector2d smear_px = pixel_at(0.5 * smear_m) - pixel_at(-0.5 * smear_m);
    std::vector<double> x;
    const int parts = static_cast<int>(std::ceil(2.0 * smear_px.norm()));
    for (int i = 0; i < parts; ++i) x.push_back(smear_m * ((i + 0.5) / parts - 0.5));
    const MovingLayer moved = paint(camera, rays, body, x);
    CAPTURE(smear_px.norm(), parts);
    CHECK((moments_of(moved).centroid - moments_of(still).centroid).norm() <
          0.006);  // the pixels' own sampling, see above
    const double grown = smear_px.squaredNorm() / 12.0 * (1.0 - 1.0 / (parts * parts));
    const double seen = variance_along(moved, smear_px.normalized()) - variance_along(still, smear_px.normalized());
    CHECK(std::abs(seen - grown) < 0.01 * grown + 0.01);
    CHECK(std::abs(moments_of(moved).area / moments_of(still).area - 1.0) < 1e-3);
  }
}

namespace {

/// Radiance and coverage of a single box by 24 x 24 rays a pixel: the nearest face that each ray meets.
struct CastPixel {
  double radiance = 0.0, coverage = 0.0;
};
CastPixel cast_box(const Camera& camera, const MovingBox& box, int u, int v) {
  constexpr int kRays = 24;
  CastPixel pixel;
  for (int i = 0; i < kRays * kRays; ++i) {
    const Eigen::Vector2d at(u - 0.5 + (i % kRays + 0.5) / kRays, v - 0.5 + (i / kRays + 0.5) / kRays);
    const Eigen::Vector3d along =
        box.axes_W.transpose() * camera.X_WC.linear() * undistorted_at(camera, at)->homogeneous();
    const Eigen::Vector3d from = box.axes_W.transpose() * (camera.X_WC.translation() - box.center_W);
    double enter = -1e9;
    double leave = 1e9;
    int face = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double near = (-std::copysign(box.half_m[axis], along[axis]) - from[axis]) / along[axis];
      const double far = (std::copysign(box.half_m[axis], along[axis]) - from[axis]) / along[axis];
      if (near > enter) {
        enter = near;
        face = 2 * axis + (along[axis] > 0.0 ? 0 : 1);
      }
      leave = std::min(leave, far);
    }
    if (enter >= leave || enter <= 0.0) continue;
    pixel.radiance += box.radiance[static_cast<std::size_t>(face)] / (kRays * kRays);
    pixel.coverage += 1.0 / (kRays * kRays);
  }
  return pixel;
}

}  // namespace

TEST_CASE("A box's pixels are those of rays cast at it, however it is turned") {
  // Areas are exact; 24 x 24 rays err by up to 1/24 of a pixel along an edge that runs with the grid, times the largest
  // difference of radiance, 0.9; and by some 1e-3 in the sum over all pixels.
  const Camera camera = paper_like_camera(kBarrel);
  const RayTable rays = make_ray_table(camera);
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(-0.5, 0.1, 0.0), Eigen::Vector3d(0.1, 0.15, 0.0),
                                       Eigen::Vector3d(0.6, -0.4, 0.1), Eigen::Vector3d(0.0, 0.5, -0.2)}) {
    for (const double turn : {0.0, 0.3, 0.8}) {
      MovingBox box;
      box.center_W = place;
      box.axes_W =
          (Eigen::AngleAxisd(0.07, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(0.5 * turn, Eigen::Vector3d::UnitX()))
              .toRotationMatrix();
      box.half_m = {0.05, 0.02, 0.03};
      box.radiance = {0.2, 0.4, 0.1, 0.9, 0.3, 0.6};
      MovingBody body;
      body.boxes.push_back(box);
      const MovingLayer layer = paint(camera, rays, body, kStill);
      double worst = 0.0;
      double total = 0.0;
      double total_cast = 0.0;
      const PixelRect seen = seen_part(layer);
      for (int y = seen.y; y < seen.y + seen.height; ++y) {
        for (int x = seen.x; x < seen.x + seen.width; ++x) {
          const std::size_t at = static_cast<std::size_t>(y - layer.rect.y) * layer.rect.width + (x - layer.rect.x);
          const CastPixel cast = cast_box(camera, box, x, y);
          worst = std::max({worst, std::abs(static_cast<double>(layer.radiance[at]) - cast.radiance),
                            std::abs(static_cast<double>(layer.coverage[at]) - cast.coverage)});
          total += static_cast<double>(layer.radiance[at]);
          total_cast += cast.radiance;
        }
      }
      CAPTURE(place.transpose(), turn);
      CHECK(worst < 0.045);
      CHECK(std::abs(total / total_cast - 1.0) < 2e-3);
      // Nothing of it lies outside the rectangle.
      for (int x = seen.x - 1; x <= seen.x + seen.width; ++x) {
        CHECK(cast_box(camera, box, x, seen.y - 1).coverage == 0.0);
        CHECK(cast_box(camera, box, x, seen.y + seen.height).coverage == 0.0);
      }
    }
  }
}

TEST_CASE("A body that is out of the image leaves an empty layer, one that is half in it a part") {
  const Camera camera = paper_like_camera(kBarrel);
  const RayTable rays = make_ray_table(camera);
  MovingBody body = marker_at(camera, {400, 300}, 2.4, 6.0);
  body.direction_W = Eigen::Vector3d::UnitX();
  CHECK(paint(camera, rays, body, std::array<double, 1>{3.0}).rect.empty());
  const Eigen::Vector2d edge = project(camera, body.marker->center_W + 0.79 * body.direction_W).value();
  const MovingLayer half = paint(camera, rays, body, std::array<double, 1>{0.79});
  CAPTURE(edge.transpose());
  REQUIRE_FALSE(half.rect.empty());
  CHECK(half.rect.x + half.rect.width == 800);
}

TEST_CASE("A body that reaches behind the camera is an error") {
  const Camera camera = paper_like_camera(kNoLens);
  const RayTable rays = make_ray_table(camera);
  MovingBody body = marker_at(camera, {400, 300}, 2.4, 6.0);
  body.direction_W = Eigen::Vector3d::UnitZ();
  CHECK_THROWS_AS(paint(camera, rays, body, std::array<double, 1>{5.0}), glidelab::base::NumericalError);
}

TEST_CASE("A layer goes over an image by its coverage") {
  MovingLayer layer{{1, 0, 2, 1}, {0.5f, 0.25f}, {1.0f, 0.5f}};
  FloatImage image(3, 1);
  image.values = {10.0f, 20.0f, 30.0f};
  put_over(layer, 100.0f, image);
  CHECK(image.values == std::vector<float>{10.0f, 50.0f, 40.0f});
}
