#include "render/paint/static_painter.h"

#include <cmath>

#include "render/film/truth_files.h"
#include "tests/catch.h"
#include "tests/render/tilted_board.h"

using namespace glidelab::render;

namespace {

Camera camera_for_tests() {
  Camera camera;
  camera.width_px = 320;
  camera.height_px = 240;
  camera.focal_px = {480.0, 481.0};
  camera.center_px = {161.2, 117.9};
  camera.lens = {-0.2, 0.08, 0.0, 0.0007, -0.0005};
  camera.X_WC = look_at({0.15, 0.2, 2.4}, {0.0, 0.0, 0.0}, 0.02);
  return camera;
}

/// An even wall, even light.
StaticScene bare_scene() {
  StaticScene scene;
  scene.light_falloff = 0.0;
  return scene;
}

Eigen::Vector3d ray_W(const Camera& camera, double u, double v) {
  return camera.X_WC.linear() * undistorted_at(camera, {u, v}).value().homogeneous();
}

/// The part of a pixel, by n x n rays, of which `hit(ray)` is true.
template <typename Hit>
double part_of_pixel(const Camera& camera, int u, int v, int n, const Hit& hit) {
  int hits = 0;
  for (int i = 0; i < n * n; ++i) {
    hits += hit(ray_W(camera, u - 0.5 + (i % n + 0.5) / n, v - 0.5 + (i / n + 0.5) / n)) ? 1 : 0;
  }
  return hits / static_cast<double>(n * n);
}

}  // namespace

TEST_CASE("The chessboard's pixels are the areas of its squares, by rays cast one by one in double") {
  // 32 x 32 rays err by up to 1/32 of a pixel where an edge runs along the grid, typically 1/100; the shader's 64
  // filtered rays by less. The mean over all edge pixels shows a bias that single pixels would hide: sd 0.01 /
  // sqrt(2000) = 2e-4.
  const Camera camera = camera_for_tests();
  StaticScene scene = bare_scene();
  scene.board = glidelab::tests::tilted_board();
  StaticPainter painter(camera, make_ray_table(camera));
  const FloatImage image = painter.paint(scene);
  const Eigen::Isometry3d X_PW = scene.board->X_WP.inverse();
  const double shade = shade_of(-scene.board->X_WP.linear().col(2));
  const auto square_of = [&](const Eigen::Vector3d& ray) {
    const Eigen::Vector3d from = X_PW * camera.X_WC.translation();
    const Eigen::Vector3d along = X_PW.linear() * ray;
    const Eigen::Vector3d p = (from - along * (from.z() / along.z())) / scene.board->square_m;
    return Eigen::Vector2d(p.x(), p.y());
  };
  double worst = 0.0;
  double sum = 0.0;
  int edges = 0;
  for (int v = 20; v < 220; ++v) {
    for (int u = 20; u < 300; ++u) {
      // Only pixels whose corners all lie on the plate.
      bool on_plate = true;
      for (const auto& [du, dv] : {std::pair{-0.6, -0.6}, {0.6, -0.6}, {-0.6, 0.6}, {0.6, 0.6}}) {
        const Eigen::Vector2d p = square_of(ray_W(camera, u + du, v + dv));
        on_plate = on_plate && p.x() > -2 && p.y() > -2 && p.x() < 6 && p.y() < 5;
      }
      if (!on_plate) continue;
      const double black = part_of_pixel(camera, u, v, 24, [&](const Eigen::Vector3d& ray) {
        const Eigen::Vector2d p = square_of(ray);
        const int column = static_cast<int>(std::floor(p.x()));
        const int row = static_cast<int>(std::floor(p.y()));
        return column >= -1 && row >= -1 && column < 5 && row < 4 && (column + row) % 2 == 0;
      });
      const double seen = (0.85 - static_cast<double>(image.at(u, v)) / shade) / 0.80;
      worst = std::max(worst, std::abs(seen - black));
      if (black > 0.0 && black < 1.0) {
        sum += seen - black;
        ++edges;
      }
    }
  }
  CAPTURE(edges);
  REQUIRE(edges > 1000);
  CHECK(worst < 0.045);
  CHECK(std::abs(sum / edges) < 1e-3);
}

TEST_CASE("A black box before the wall covers the pixels that rays say") {
  // 64 rays of a Sobol set against 32 x 32 of a grid: each off by some 1/64 along an edge, 1/32 at worst.
  const Camera camera = camera_for_tests();
  StaticScene scene = bare_scene();
  StaticPainter painter(camera, make_ray_table(camera));
  const FloatImage wall = painter.paint(scene);
  StaticBox box;
  box.center_W = {0.1, 0.05, 0.02};
  box.half_m = {0.3, 0.05, 0.04};
  box.turn_rad = -0.12;
  box.albedo = 0.0;
  box.casts_shadow = false;
  scene.boxes.push_back(box);
  const FloatImage image = painter.paint(scene);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(box.turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  double worst = 0.0;
  double area = 0.0;
  double cast_area = 0.0;  // the box is about 125 x 30 px about (180, 110)
  for (int v = 90; v < 140; ++v) {
    for (int u = 110; u < 260; ++u) {
      const double cast = part_of_pixel(camera, u, v, 16, [&](const Eigen::Vector3d& ray) {
        const Eigen::Vector3d from = turn.transpose() * (camera.X_WC.translation() - box.center_W);
        const Eigen::Vector3d along = turn.transpose() * ray;
        const Eigen::Vector3d a = (-box.half_m - from).cwiseQuotient(along);
        const Eigen::Vector3d b = (box.half_m - from).cwiseQuotient(along);
        return a.cwiseMin(b).maxCoeff() < a.cwiseMax(b).minCoeff();
      });
      const double seen = 1.0 - static_cast<double>(image.at(u, v)) / static_cast<double>(wall.at(u, v));
      worst = std::max(worst, std::abs(seen - cast));
      area += seen;
      cast_area += cast;
    }
  }
  CHECK(worst < 0.1);
  CHECK(std::abs(area / cast_area - 1.0) < 1e-3);
}

TEST_CASE("The plumb line darkens each pixel by its share of the thread's width, row by row") {
  // 64 rays a pixel: an edge along the columns is right to 1/64, two of them to 1/32; the mean over all rows shows a
  // bias of the line's place, sd 0.01 / sqrt(230) = 7e-4 of a pixel's darkness.
  const Camera camera = camera_for_tests();
  StaticScene scene = bare_scene();
  StaticPainter painter(camera, make_ray_table(camera));
  const FloatImage wall = painter.paint(scene);
  for (const double diameter_m : {0.0025, 0.01}) {
    scene.plumb =
        PlumbLine{.x_m = 0.37, .z_m = 0.0, .top_y_m = 3.0, .bottom_y_m = -2.0, .diameter_m = diameter_m, .albedo = 0.0};
    const FloatImage image = painter.paint(scene);
    double worst = 0.0;
    double sum = 0.0;
    int rows = 0;
    for (int v = 5; v < 235; ++v) {
      // Where the axis crosses the middle of the row, by bisection, and how wide the thread is there.
      double low = -2.0;
      double high = 3.0;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        const auto pixel = project(camera, {0.37, middle, 0.0});
        (pixel && pixel->y() > v ? low : high) = middle;
      }
      const double axis = project(camera, {0.37, low, 0.0})->x();
      const Eigen::Vector3d to_eye = camera.X_WC.translation() - Eigen::Vector3d(0.37, low, 0.0);
      const Eigen::Vector3d across = to_eye.cross(Eigen::Vector3d::UnitY()).normalized() * (0.5 * diameter_m);
      const double half = 0.5 * (project(camera, Eigen::Vector3d(0.37, low, 0.0) + across).value() -
                                 project(camera, Eigen::Vector3d(0.37, low, 0.0) - across).value())
                                    .norm();
      double moment = 0.0;
      for (int u = static_cast<int>(axis) - 3; u <= static_cast<int>(axis) + 4; ++u) {
        const double dark = 1.0 - static_cast<double>(image.at(u, v)) / static_cast<double>(wall.at(u, v));
        const double expected = std::max(0.0, std::min(u + 0.5, axis + half) - std::max(u - 0.5, axis - half));
        worst = std::max(worst, std::abs(dark - expected));
        moment += (dark - expected) * (u - axis);
      }
      sum += moment / (2.0 * half);
      ++rows;
    }
    CAPTURE(diameter_m);
    CHECK(worst < 0.045);
    CHECK(std::abs(sum / rows) < 0.005);
  }
}

TEST_CASE("The same scene gives the same image, and what stands nearer hides what stands behind") {
  const Camera camera = camera_for_tests();
  StaticScene scene = bare_scene();
  scene.board = glidelab::tests::tilted_board();
  StaticBox box;
  box.center_W = {0.0, 0.0, -0.3};
  box.half_m = {0.5, 0.5, 0.05};
  box.albedo = 0.9;
  scene.boxes.push_back(box);
  const RayTable rays = make_ray_table(camera);
  StaticPainter painter(camera, rays);
  const FloatImage first = painter.paint(scene);
  CHECK(painter.paint(scene).values == first.values);
  StaticPainter other(camera, rays);
  CHECK(other.paint(scene).values == first.values);
  // The middle of the black corner square of the board, before the white box.
  const Eigen::Vector2d corner = project(camera, scene.board->X_WP * Eigen::Vector3d(-0.055, -0.055, 0.0)).value();
  CHECK(first.at(static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y()))) < 0.1f);
}

TEST_CASE("A board or a plumb line painted before the empty scene gives the image painted whole") {
  const Camera camera = camera_for_tests();
  const RayTable rays = make_ray_table(camera);
  StaticScene scene = bare_scene();
  scene.light_falloff = 0.3;
  StaticBox track;  // in front of a part of the board, with edges all over the image
  track.center_W = {0.0, -0.25, 0.35};
  track.half_m = {0.9, 0.06, 0.03};
  track.turn_rad = 0.07;
  track.surface = Surface::scale_tape;
  scene.boxes.push_back(track);
  StaticPainter painter(camera, rays);
  const FloatImage empty = painter.paint(scene);
  SECTION("a board") {
    scene.board = glidelab::tests::tilted_board();
  }
  SECTION("a board at the image's corner, part of it outside") {
    scene.board = glidelab::tests::tilted_board();
    scene.board->X_WP.translation() += Eigen::Vector3d(0.5, -0.35, 0.1);
  }
  SECTION("a plumb line") {
    scene.plumb = PlumbLine{};
    scene.plumb->z_m = 0.2;
  }
  const FloatImage whole = painter.paint(scene);
  CHECK(painter.paint_before(empty, scene).values == whole.values);
  CHECK(whole.values != empty.values);
}
