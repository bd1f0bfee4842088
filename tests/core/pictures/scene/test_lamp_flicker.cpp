#include "core/pictures/scene/lamp_flicker.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// 200 frames at 120 Hz of a scene lit by 1 + depth cos(2 pi 100 Hz t).
std::shared_ptr<const core::ImageRecord> record_of(double depth, bool lossy) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 0.0004);
  auto record = std::make_shared<core::ImageRecord>();
  record->height_px = 200;
  record->lossy = lossy;
  for (std::size_t k = 0; k < 200; ++k) {
    core::SceneLook look;
    look.frame = k;
    look.t_s = static_cast<double>(k) / 120.0;
    look.gain.fill(depth * std::cos(2.0 * std::numbers::pi * 100.0 * look.t_s) + normal(random));
    look.gain_sd.fill(0.0004);
    record->scene.push_back(look);
  }
  return record;
}

core::CameraSettings camera_of(double exposure_s) {
  core::CameraSettings camera;
  camera.frame_rate_hz = 120.0;
  camera.exposure_s = exposure_s;
  return camera;
}

}  // namespace

TEST_CASE("mains light is told from its alias, with the depth before the exposure's average") {
  const auto flicker = core::find_flicker({record_of(0.03, false)}, camera_of(0.004));
  REQUIRE(flicker);
  CHECK(flicker->f_hz == 100.0);
  CHECK(std::abs(flicker->seen_hz - 20.0) < 0.1);
  // sin(0.4 pi) / 0.4 pi passes. Frequencies are tried a quarter of the peak's width apart: up to an eighth of it off,
  // sin(pi/8) / (pi/8) = 0.974 of the amplitude is found.
  const double passed = std::sin(0.4 * std::numbers::pi) / (0.4 * std::numbers::pi);
  CHECK(flicker->depth < 1.01 * 0.03 / passed);
  CHECK(flicker->depth > 0.97 * 0.03 / passed);
  CHECK_FALSE(core::find_flicker({record_of(0.0, false)}, camera_of(0.004)));
  CHECK(core::find_flicker({record_of(0.006, false)}, camera_of(0.001)));
  CHECK_FALSE(core::find_flicker({record_of(0.006, true)}, camera_of(0.001)));  // a codec's key frames do as much
}

TEST_CASE("the displacement by a flicker is the largest shift of the light's centre of time") {
  const core::LightFlicker flicker{0.1, 100.0, 20.0};
  for (const double exposure_s : {0.001, 0.004, 0.008}) {
    double largest_s = 0.0;
    for (double phase = 0.0; phase < 6.28; phase += 0.01) {
      double light = 0.0, moment = 0.0;
      constexpr int kSteps = 400;
      for (int k = 0; k < kSteps; ++k) {
        const double t = ((k + 0.5) / kSteps - 0.5) * exposure_s;
        moment += t * (1.0 + 0.1 * std::cos(2.0 * std::numbers::pi * 100.0 * t + phase));
        light += 1.0;
      }
      largest_s = std::max(largest_s, std::abs(moment / light));
    }
    // Relative to the mean light, not to that of the frame: the sum above does the same.
    CHECK(std::abs(core::flicker_displacement_px(flicker, camera_of(exposure_s), 500.0, 10.0) / (500.0 * largest_s) -
                   1.0) < 1e-3);
  }
  core::CameraSettings rolling = camera_of(0.0);
  rolling.shutter = core::Shutter::rolling;
  rolling.line_readout_s = 1e-5;
  // 0.1 * 2 pi 100 Hz * 10 us a row, times r²/4.
  CHECK(std::abs(core::flicker_displacement_px(flicker, rolling, 500.0, 10.0) -
                 25.0 * 0.1 * 200.0 * std::numbers::pi * 1e-5) < 1e-9);
}

TEST_CASE("the brightness of the scene is that of the row's band, or of the others") {
  core::ImageRecord record;
  record.height_px = 200;
  core::SceneLook look;
  look.gain = {0.1, 0.2, 0.3, 0.4};
  look.gain_sd = {0.01, 0.01, 0.01, 0.0};
  record.scene.push_back(look);
  CHECK(core::scene_brightness(record, 0, 60.0) == 1.2);
  CHECK(std::abs(core::scene_brightness(record, 0, 199.0) - 1.2) < 1e-12);
  CHECK(core::scene_brightness(record, 5, 60.0) == 1.0);
}
