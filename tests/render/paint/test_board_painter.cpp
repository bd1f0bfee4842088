#include "render/paint/board_painter.h"

#include <cmath>
#include <utility>

#include "render/paint/static_painter.h"
#include "tests/catch.h"
#include "tests/render/tilted_board.h"

using namespace glidelab::render;

namespace {

Camera camera_for_tests(const Lens& lens = {-0.2, 0.08, 0.0, 0.0007, -0.0005}) {
  Camera camera;
  camera.width_px = 320;
  camera.height_px = 240;
  camera.focal_px = {480.0, 481.0};
  camera.center_px = {161.2, 117.9};
  camera.lens = lens;
  camera.X_WC = look_at({0.15, 0.2, 2.4}, {0.0, 0.0, 0.0}, 0.02);
  return camera;
}

/// In squares, where the ray of a point of the image meets the board; cast in double through the exact lens.
Eigen::Vector2d on_board(const Camera& camera, const Chessboard& board, double u, double v) {
  const Eigen::Isometry3d X_PC = board.X_WP.inverse() * camera.X_WC;
  const Eigen::Vector3d from = X_PC.translation();
  const Eigen::Vector3d along = X_PC.linear() * undistorted_at(camera, {u, v}).value().homogeneous();
  return Eigen::Vector2d((from - along * (from.z() / along.z())).head<2>() / board.square_m);
}

}  // namespace

TEST_CASE("A painted board's pixels are the areas of its squares and of its plate, by rays cast one by one") {
  // n x n rays err by up to 1/n of a pixel where an edge runs along the grid, by some 0.3 / n typically; over all edge
  // pixels the mean shows a bias that single ones would hide: 0.01 / sqrt(2000) = 2e-4.
  constexpr int kRays = 24;
  const Camera camera = camera_for_tests();
  StaticScene scene;
  scene.light_falloff = 0.0;
  scene.board = glidelab::tests::tilted_board();
  const Chessboard& board = *scene.board;
  // Nothing behind the board: what is seen is its light alone.
  const FloatImage image =
      paint_board(camera, make_ray_table(camera), FloatImage(camera.width_px, camera.height_px), scene, 1.0);
  const double shade = shade_of(-board.X_WP.linear().col(2));
  double worst = 0.0, sum = 0.0;
  int edges = 0;
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const auto albedo_at = [&](double x, double y) {
        const Eigen::Vector2d p = on_board(camera, board, x, y);
        if (!(p.x() > -2 && p.y() > -2 && p.x() < 6 && p.y() < 5)) return 0.0;
        const int column = static_cast<int>(std::floor(p.x())), row = static_cast<int>(std::floor(p.y()));
        const bool black = column >= -1 && row >= -1 && column < 5 && row < 4 && (column + row) % 2 == 0;
        return black ? board.black_albedo : board.white_albedo;
      };
      // A square is far larger than a pixel: one whose corners and middle look alike lies within one of them.
      const double middle = albedo_at(u, v);
      bool even = true;
      for (const auto& [x, y] : {std::pair{-0.6, -0.6}, {0.6, -0.6}, {-0.6, 0.6}, {0.6, 0.6}}) {
        even = even && albedo_at(u + x, v + y) == middle;
      }
      double seen = even ? middle : 0.0;
      for (int i = 0; i < (even ? 0 : kRays * kRays); ++i) {
        seen += albedo_at(u - 0.5 + (i % kRays + 0.5) / kRays, v - 0.5 + (i / kRays + 0.5) / kRays) / (kRays * kRays);
      }
      const double off = (static_cast<double>(image.at(u, v)) / shade - seen) / 0.80;
      worst = std::max(worst, std::abs(off));
      const double whole = std::min(std::abs(seen), std::min(std::abs(seen - 0.05), std::abs(seen - 0.85)));
      if (whole < 1e-6) continue;
      sum += off;
      ++edges;
    }
  }
  CAPTURE(edges, worst);
  REQUIRE(edges > 1500);
  CHECK(worst < 1.0 / kRays);
  CHECK(std::abs(sum / edges) < 5e-4);
}

TEST_CASE("Before a camera without distortion that faces it, each pixel of a board is the product of two overlaps") {
  Camera camera = camera_for_tests(Lens{});
  camera.X_WC = look_at({0.0, 0.0, 2.0}, {0.0, 0.0, 0.0}, 0.0);
  camera.focal_px = {400.0, 400.0};
  StaticScene scene;
  scene.light_falloff = 0.0;
  Chessboard board;
  board.square_m = 0.0931;  // 18.62 px
  board.inner_columns = 6;
  board.inner_rows = 5;
  board.X_WP.linear() = Eigen::AngleAxisd(std::acos(-1.0), Eigen::Vector3d::UnitX()).toRotationMatrix();
  board.X_WP.translation() = Eigen::Vector3d(-0.2153, 0.1807, 0.0);
  scene.board = board;
  const FloatImage image =
      paint_board(camera, make_ray_table(camera), FloatImage(camera.width_px, camera.height_px), scene, 2.0);
  const double side = 18.62, shade = 2.0 * shade_of(Eigen::Vector3d::UnitZ());
  const Eigen::Vector2d first = project(camera, board.X_WP.translation()).value();
  // Of a pixel, along one axis: the part in even squares less that in odd ones, and the part on squares, on the plate.
  const auto along = [&](double pixel, double origin, int last) {
    Eigen::Array3d parts = Eigen::Array3d::Zero();
    const auto overlap = [&](double low, double high) {
      return std::max(0.0, std::min(pixel + 0.5, origin + side * high) - std::max(pixel - 0.5, origin + side * low));
    };
    for (int square = -1; square < last; ++square)
      parts[0] += (square % 2 == 0 ? 1.0 : -1.0) * overlap(square, square + 1);
    parts[1] = overlap(-1.0, last);
    parts[2] = overlap(-2.0, last + 1.0);
    return parts;
  };
  double worst = 0.0;
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::Array3d x = along(u, first.x(), 6), y = along(v, first.y(), 5);
      const double black = 0.5 * (x[1] * y[1] + x[0] * y[0]);
      const double expected = shade * (0.85 * (x[2] * y[2] - black) + 0.05 * black);
      worst = std::max(worst, std::abs(static_cast<double>(image.at(u, v)) - expected));
    }
  }
  CHECK(worst < 1e-4);  // the rays are kept in single precision: 320 px / 2^24 = 2e-5 px
}

TEST_CASE("A board before the track is painted as the ray caster paints it") {
  // The ray caster's filtered rays err by up to 0.045 of the contrast at edges (test_static_painter.cpp); the light is
  // that of the pixel's middle here and of each ray there.
  const Camera camera = camera_for_tests();
  const RayTable rays = make_ray_table(camera, Vignetting{true, {}});
  StaticScene scene;
  scene.light_falloff = 0.4;
  scene.light_gradient_per_m = {0.2, -0.1};
  StaticBox track;
  track.center_W = {0.0, -0.1, -0.1};
  track.half_m = {0.9, 0.06, 0.03};
  track.surface = Surface::matt;
  scene.boxes.push_back(track);
  StaticPainter painter(camera, rays);
  const FloatImage empty = painter.paint(scene);
  scene.board = glidelab::tests::tilted_board();
  REQUIRE(stands_free(camera, scene));
  const FloatImage cast = painter.paint_before(empty, scene, 1.0),
                   painted = paint_board(camera, rays, empty, scene, 1.0);
  double worst = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < cast.values.size(); ++i) {
    const double off = static_cast<double>(painted.values[i]) - static_cast<double>(cast.values[i]);
    worst = std::max(worst, std::abs(off));
    sum += off;
  }
  CHECK(worst < 0.045);
  CHECK(std::abs(sum / static_cast<double>(cast.values.size())) < 2e-5);
  CHECK(painted.values != empty.values);
}

TEST_CASE("A board stands free unless a box is before it or between it and the lamp") {
  const Camera camera = camera_for_tests();
  StaticScene scene;
  CHECK_FALSE(stands_free(camera, scene));  // there is none
  scene.board = glidelab::tests::tilted_board();
  CHECK(stands_free(camera, scene));
  StaticBox box;
  box.half_m = {0.1, 0.1, 0.02};
  box.turn_rad = 0.3;
  const Eigen::Vector3d middle = scene.board->X_WP * Eigen::Vector3d(0.2, 0.15, 0.0);
  const auto with_box_at = [&](const Eigen::Vector3d& center) {
    StaticScene changed = scene;
    box.center_W = center;
    changed.boxes.push_back(box);
    return stands_free(camera, changed);
  };
  const Eigen::Vector3d to_eye = camera.X_WC.translation() - middle;
  CHECK_FALSE(with_box_at(middle + 0.5 * to_eye));
  CHECK(with_box_at(middle - 0.5 * to_eye));
  CHECK(with_box_at(middle + 2.0 * to_eye));
  CHECK_FALSE(with_box_at(middle + 1.5 * kToLight));
  box.casts_shadow = false;
  CHECK(with_box_at(middle + 1.5 * kToLight + Eigen::Vector3d(-0.3, 0.3, 0.0)));
  // From behind nothing of it is printed.
  scene.board->X_WP.linear().col(1) *= -1.0;
  scene.board->X_WP.linear().col(2) *= -1.0;
  CHECK_FALSE(stands_free(camera, scene));
}
