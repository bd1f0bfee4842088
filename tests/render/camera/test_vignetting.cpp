#include "render/camera/optics.h"

#include <cmath>

#include "render/paint/moving_painter.h"
#include "render/paint/static_painter.h"
#include "tests/catch.h"

using namespace glidelab::render;

namespace {

Camera small_camera() {
  Camera camera;
  camera.width_px = 200;
  camera.height_px = 150;
  camera.focal_px = {150.0, 150.0};
  camera.center_px = {99.5, 74.5};
  camera.X_WC = look_at({0.0, 0.0, 2.0}, {0.0, 0.0, 0.0}, 0.0);
  return camera;
}

}  // namespace

TEST_CASE("cos⁴ is that of the angle to the axis, and the radial table is linear in the radius") {
  const Camera camera = small_camera();
  Vignetting vignetting;
  vignetting.cos4 = true;
  const double theta = 0.4;
  CHECK(std::abs(gain_at(vignetting, camera, {0, 0}, {std::tan(theta), 0.0}) - std::pow(std::cos(theta), 4)) < 1e-14);
  vignetting = {false, {{0.0, 1.0}, {100.0, 0.8}, {200.0, 0.4}}};
  CHECK(gain_at(vignetting, camera, camera.center_px, {0, 0}) == 1.0);
  CHECK(std::abs(gain_at(vignetting, camera, camera.center_px + Eigen::Vector2d(30.0, 40.0), {0, 0}) - 0.9) < 1e-14);
  CHECK(std::abs(gain_at(vignetting, camera, camera.center_px + Eigen::Vector2d(-150.0, 0.0), {0, 0}) - 0.6) < 1e-14);
  CHECK_THROWS_AS(gain_at(vignetting, camera, camera.center_px + Eigen::Vector2d(201.0, 0.0), {0, 0}),
                  std::logic_error);
}

TEST_CASE("What stands still and what moves get the same vignetting") {
  // The image with it over the one without, pixel by pixel: single precision.
  const Camera camera = small_camera();
  const Vignetting vignetting{true, {{0.0, 1.0}, {200.0, 0.5}}};
  const RayTable plain = make_ray_table(camera);
  const RayTable dark = make_ray_table(camera, vignetting);
  REQUIRE(plain.gain.empty());
  const StaticScene wall;
  const FloatImage bright = StaticPainter(camera, plain).paint(wall);
  const FloatImage darker = StaticPainter(camera, dark).paint(wall);
  MovingBody body;
  body.marker = MarkerSphere{{0.8, 0.5, 0.0}, 0.1, 1.0};
  const double still[] = {0.0};
  const MovingLayer layer = paint(camera, plain, body, still);
  const MovingLayer dark_layer = paint(camera, dark, body, still);
  REQUIRE(layer.rect == dark_layer.rect);
  CHECK(layer.coverage == dark_layer.coverage);
  for (int y = 0; y < camera.height_px; y += 7) {
    for (int x = 0; x < camera.width_px; x += 7) {
      const Eigen::Vector2d pixel(x, y);
      const double gain = gain_at(vignetting, camera, pixel, undistorted_at(camera, pixel).value());
      CHECK(std::abs(static_cast<double>(darker.at(x, y)) - gain * static_cast<double>(bright.at(x, y))) < 1e-6);
    }
  }
  const std::size_t at = layer.radiance.size() / 2;
  const Eigen::Vector2d pixel(layer.rect.x + static_cast<int>(at) % layer.rect.width,
                              layer.rect.y + static_cast<int>(at) / layer.rect.width);
  const double gain = gain_at(vignetting, camera, pixel, undistorted_at(camera, pixel).value());
  CHECK(gain < 0.8);
  CHECK(std::abs(static_cast<double>(dark_layer.radiance[at]) - gain * static_cast<double>(layer.radiance[at])) < 1e-6);
}
