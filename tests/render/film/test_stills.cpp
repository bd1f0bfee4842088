#include "render/film/stills.h"

#include <cmath>
#include <tuple>

#include "tests/catch.h"
#include "tests/render/tilted_camera.h"

using namespace glidelab::render;

TEST_CASE("Every calibration view shows the whole board with its border, and together they fill the image") {
  Scenario scenario = glidelab::tests::tilted_camera();
  for (const auto& [columns, rows, square] : {std::tuple{9, 6, 0.04}, {11, 8, 0.03}, {5, 4, 0.1}, {7, 7, 0.02}}) {
    scenario.pattern.inner_columns = columns;
    scenario.pattern.inner_rows = rows;
    scenario.pattern.square_m = square;
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      const std::vector<Chessboard> boards = calibration_boards(scenario, seed);
      REQUIRE(boards.size() == 12);
      Eigen::Vector2d low(1e9, 1e9);
      Eigen::Vector2d high(-1e9, -1e9);
      double steepest = 0.0;
      for (const Chessboard& board : boards) {
        // Seen from its printed side: Z away from the camera.
        const Eigen::Vector3d away = board.X_WP.translation() - scenario.camera.X_WC.translation();
        CHECK(board.X_WP.linear().col(2).dot(away) > 0.0);
        CHECK(std::abs(board.X_WP.linear().determinant() - 1.0) < 1e-12);
        for (const Eigen::Vector3d& corner : outline_of(board)) {
          const auto pixel = project(scenario.camera, corner);
          REQUIRE(pixel);
          CHECK(in_image(scenario.camera, *pixel, 1.0));
          low = low.cwiseMin(*pixel);
          high = high.cwiseMax(*pixel);
        }
        const double cosine = board.X_WP.linear().col(2).dot(scenario.camera.X_WC.linear().col(2));
        steepest = std::max(steepest, std::acos(std::min(1.0, cosine)));
      }
      CHECK(low.x() < 80.0);
      CHECK(low.y() < 60.0);
      CHECK(high.x() > 720.0);
      CHECK(high.y() > 540.0);
      CHECK(steepest > 0.5);   // 29 degrees
      CHECK(steepest < 0.70);  // 40 degrees
    }
  }
}

TEST_CASE("Calibration views are the same for one seed and others for another") {
  const Scenario scenario = glidelab::tests::tilted_camera();
  const auto first = calibration_boards(scenario, 1);
  const auto again = calibration_boards(scenario, 1);
  const auto other = calibration_boards(scenario, 2);
  for (std::size_t i = 0; i < first.size(); ++i) {
    CHECK(first[i].X_WP.matrix() == again[i].X_WP.matrix());
    CHECK(first[i].X_WP.matrix() != other[i].X_WP.matrix());
  }
}
