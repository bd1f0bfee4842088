#include "render/scenario/scene.h"

#include <cmath>

#include "render/film/truth_files.h"
#include "tests/catch.h"
#include "tests/render/tilted_camera.h"

using namespace glidelab::render;

TEST_CASE("The plane board lies in z = 0, its X along the track up to its rotation, its Z away from the camera") {
  Scenario scenario = glidelab::tests::tilted_camera();
  scenario.pattern.plane_x_m = {0.1, -0.4};
  scenario.pattern.plane_rotation_rad = 0.02;
  for (std::size_t view = 0; view < 2; ++view) {
    const Chessboard board = plane_board(scenario, view);
    const Eigen::Matrix3d axes = board.X_WP.linear();
    CHECK(std::abs(axes.determinant() - 1.0) < 1e-12);
    CHECK(axes.col(2) == Eigen::Vector3d(0.0, 0.0, -1.0));
    // The track falls to the right by 0.07 rad; the board is turned anticlockwise by 0.02.
    CHECK(std::abs(std::atan2(axes.col(0).y(), axes.col(0).x()) + 0.05) < 1e-12);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : outline_of(board)) middle += 0.25 * corner;
    CHECK((middle - scenario.pattern.plane_x_m[view] * track_direction_W(scenario.track, 0.07)).norm() < 1e-12);
  }
}

TEST_CASE("x counts downhill whichever way the track falls, and the pattern's origin is where its corner projects") {
  Scenario scenario = glidelab::tests::tilted_camera();
  for (const int downhill : {1, -1}) {
    scenario.track.downhill = downhill;
    const Eigen::Vector3d step = marker_position_W(scenario, 0.07, 1.0) - marker_position_W(scenario, 0.07, 0.0);
    CHECK(std::abs(step.x() - downhill * std::cos(0.07)) < 1e-15);
    CHECK(std::abs(step.y() + std::sin(0.07)) < 1e-15);
    const Eigen::Vector3d corner = plane_board(scenario, 0).X_WP.translation();
    const Eigen::Vector3d foot = x_origin_m(scenario, 0.07) * track_direction_W(scenario.track, 0.07);
    CHECK(std::abs((corner - foot).dot(track_direction_W(scenario.track, 0.07))) < 1e-12);
    // The first corner is at the board's upper left: before the middle where x grows to the right.
    CHECK(x_origin_m(scenario, 0.07) * downhill < 0.0);
  }
}

TEST_CASE("The glider stands on its track with the marker before it, a weight more for each 100 g") {
  Scenario scenario = glidelab::tests::tilted_camera();
  scenario.marker.height_m = 0.015;
  const StaticScene track = empty_track(scenario, 0.07);
  glidelab::sim::Body body = scenario.motion.configurations.front().body;
  for (const int weights : {0, 1, 2}) {
    body.mass_kg = 0.335 + 0.1 * weights;
    const MovingBody moving = glider(scenario, track, body, 0.3);
    CHECK(moving.boxes.size() == 1u + static_cast<std::size_t>(weights));
    REQUIRE(moving.marker);
    CHECK((moving.marker->center_W + 0.3 * moving.direction_W - marker_position_W(scenario, 0.07, 0.3)).norm() < 1e-15);
    // The sphere touches the front of the body and does not sink in.
    const MovingBox& carriage = moving.boxes.front();
    CHECK(carriage.center_W.z() + carriage.half_m.z() <= 0.015 - 0.010 + 1e-12);
  }
}

TEST_CASE("The plumb's region holds the line over the wall, where the camera sees it") {
  Scenario scenario = glidelab::tests::tilted_camera();
  CHECK_FALSE(plumb_region(scenario));
  scenario.plumb = PlumbSetup{};
  const PixelRect region = plumb_region(scenario).value();
  CHECK(region.height > 200);
  CHECK(region.width < 100);
  for (double y = 0.1; y < 0.5; y += 0.05) {
    const Eigen::Vector2d pixel = project(scenario.camera, {scenario.plumb->x_m, y, 0.0}).value();
    if (pixel.y() < region.y || pixel.y() > region.y + region.height) continue;
    CHECK(pixel.x() > region.x + 10);
    CHECK(pixel.x() < region.x + region.width - 10);
  }
  scenario.plumb->x_m = 5.0;
  CHECK_FALSE(plumb_region(scenario));
}
