#include "diagnose/twin/twin.h"

#include <cmath>
#include <numbers>

#include "render/camera/camera.h"
#include "render/scenario/scenario.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kRate_hz = 120.0, kReference_m = 0.3;

diagnose::Filming filmed() {
  diagnose::Filming filming;
  filming.settings.frame_rate_hz = kRate_hz;
  filming.settings.exposure_s = 0.001;
  filming.width_px = 640;
  filming.height_px = 240;
  filming.lens = core::CameraModel{};
  filming.lens->fx = filming.lens->fy = 800.0;
  filming.lens->cx = 319.5;
  filming.lens->cy = 119.5;
  filming.lens->size = {640, 240};
  filming.X_CP.translation() = Eigen::Vector3d(-0.12, 0.02, 1.4);  // faces the plane, X to the right
  filming.marker_m = 0.02;
  filming.inner_columns = 7;
  filming.inner_rows = 4;
  filming.square_m = 0.02;
  filming.lossy = false;
  filming.noise_code = 0.9;
  return filming;
}

struct Written {
  diagnose::TwinView view;
  diagnose::TwinEffects effects;
  render::Scenario scenario;
};

/// With one level motion behind what is written of the camera.
Written written(const std::string& id, const std::vector<diagnose::DiagnosedParameter>& sizes,
                const std::optional<diagnose::Filming>& filming = filmed(), double incline_rad = 0.0) {
  Written result;
  std::vector<diagnose::DiagnosedEffect> effects;
  if (!id.empty()) effects.push_back({id, {}, "", 1.0, {}, sizes, 1.0, {}});
  result.view = diagnose::view_of(filming, kReference_m, 1.0, incline_rad);
  result.effects = diagnose::effects_of_camera(effects, filming, result.view, kRate_hz, kReference_m);
  const std::string text =
      "format = 1\nname = \"twin\"\n[camera]\nframe_rate_hz = 120\nexposure_s = " +
      std::to_string(result.effects.exposure_s) + "\n" + diagnose::camera_keys(filming, result.view) +
      result.effects.sections + diagnose::scene_sections(filming, result.view) +
      "\n[[configuration]]\nname = \"a\"\nmass_kg = 0.3\nincline_deg = 0.0\n[[configuration.force]]\nlaw = "
      "\"coulomb\"\nmu = 0.006\n[[configuration.clip]]\nname = \"c\"\nlaunched = \"down\"\nx0_m = 0.0\nv0_m_s = "
      "0.5\nduration_s = 0.5\n";
  INFO(text);
  result.scenario = render::read_scenario(text, "twin.toml", render::ScenarioChecks::values);
  return result;
}

/// x on the track that the calibrated camera makes of a point at x, seen by the mounted one; head on, level.
double seen_at(const Written& twin, double x_m) {
  const render::Scenario& scenario = twin.scenario;
  render::Camera mounted = scenario.camera;
  mounted.focal_px *= 1.0 + scenario.mount.focal_change;
  mounted.X_WC = scenario.camera.X_WC * render::mount_at(scenario.mount, 0.0);
  const auto pixel = render::project(mounted, {twin.view.downhill * x_m, scenario.camera.X_WC.translation().y(), 0.0});
  REQUIRE(pixel);
  const Eigen::Vector2d ray = *render::undistorted_at(scenario.camera, *pixel);
  const Eigen::Vector3d eye = scenario.camera.X_WC.translation(),
                        along = scenario.camera.X_WC.linear() * Eigen::Vector3d(ray.x(), ray.y(), 1.0);
  return twin.view.downhill * (eye - eye.z() / along.z() * along).x();
}

}  // namespace

TEST_CASE("effects of camera and clock stand in a twin's scenario with their sizes") {
  CHECK(std::abs(written("rolling_shutter", {{"line_s", 3e-5, 1e-7}}).scenario.recording.shutter.line_readout_s -
                 3e-5) < 1e-12);
  const auto upward = written("rolling_shutter", {{"line_s", -2e-5, 1e-7}}).scenario.recording.shutter;
  CHECK(upward.rolling);
  CHECK(upward.bottom_first);
  CHECK(written("exposure_blur", {{"exposure_s", 0.006, 1e-4}}).scenario.recording.exposure_s == 0.006);
  const auto flicker = written("light_flicker", {{"depth", 0.05, 1e-3}, {"f_hz", 100.0, 0.1}}).scenario.light;
  CHECK(flicker.flicker_depth == 0.05);
  CHECK(flicker.flicker_hz == 100.0);
  CHECK(written("light_gradient", {{"gradient", 0.6, 0.01}}).scenario.light.gradient_per_m.x() == 0.6);
  CHECK(written("compression", {{"block_steps", 0.9, 0.1}}).scenario.codec == render::Codec::mjpeg);
  CHECK(written("dropped_frames", {{"fraction", 0.02, 0.01}}).scenario.recording.clock.dropped_fraction == 0.02);
  CHECK(written("timestamp_jitter", {{"sd_s", 1e-4, 1e-5}}).scenario.recording.clock.jitter_s == 1e-4);
  // 1 % fewer frames a second than stated: the true step is 1.01 times the stated one.
  const double ppm = written("frame_rate_error", {{"e", 0.01, 1e-4}}).scenario.recording.clock.rate_error_ppm;
  CHECK(std::abs((1.0 + 1e-6 * ppm) * 1.01 - 1.0) < 1e-9);
  for (const auto& [id, key, size] :
       std::vector<std::tuple<std::string, std::string, double>>{{"rolling_shutter", "line_s", 3e-4},
                                                                 {"exposure_blur", "exposure_s", 0.02},
                                                                 {"light_gradient", "gradient", 5.0},
                                                                 {"timestamp_jitter", "sd_s", 1e-3},
                                                                 {"frame_rate_error", "e", 0.2},
                                                                 {"light_flicker", "", 0.0}}) {
    std::vector<diagnose::DiagnosedParameter> sizes = {{key, size, 1e-3}};
    if (id == "light_flicker") sizes = {{"depth", 1.2, 0.1}, {"f_hz", 100.0, 0.1}};
    const Written beyond = written(id, sizes);
    INFO(id);
    REQUIRE(beyond.effects.lacks.size() == 1);  // nothing is cut down to what a scenario allows
    CHECK(beyond.effects.lacks.front().what == id);
    CHECK(beyond.effects.sections.empty());
  }
  CHECK(written("lens_distortion", {}).effects.lacks.size() == 1);
  CHECK(written("camera_motion", {{"amplitude_px", 0.5, 0.1}}).effects.lacks.size() == 1);  // a drift
}

TEST_CASE("a wrong scale, a wrong perspective and a camera that sways are those of the list, as a twin's camera sees") {
  const Written scale = written("scale_error", {{"e", 0.03, 1e-3}});
  const double length = seen_at(scale, 0.3) - seen_at(scale, -0.2);
  CHECK(std::abs(length / 0.5 - 1.03) < 1e-6);  // rounding of the file

  const double p = 0.05;
  for (const double turned : {1.0, -1.0}) {
    diagnose::Filming filming = filmed();
    filming.along_P *= turned;  // downhill to the left
    const Written twin = written("perspective_error", {{"p_1_m", p, 1e-3}}, filming);
    CHECK(twin.view.downhill == (turned > 0.0 ? 1 : -1));
    const auto expected = [&](double x) { return (x + kReference_m) / (1.0 + p * (x + kReference_m)); };
    const double at = seen_at(twin, 0.0) - expected(0.0);
    for (const double x : {-0.3, -0.1, 0.2, 0.35}) {
      CHECK(std::abs(seen_at(twin, x) - at - expected(x)) < 1e-6);  // but for where x begins
    }
  }

  const Written sway = written("camera_motion", {{"amplitude_m", 7e-4, 1e-6}, {"f_hz", 6.0, 1e-3}});
  REQUIRE(sway.scenario.mount.motions.size() == 1);
  const render::MountMotion& motion = sway.scenario.mount.motions.front();
  CHECK(motion.frequency_hz == 6.0);
  CHECK(std::abs(1.4 * std::tan(motion.amplitude) / 7e-4 - 1.0) < 1e-6);
}

TEST_CASE("a twin's camera sees the marker and the pattern where the calibrated one does") {
  diagnose::Filming filming = filmed();
  const double tilt = 0.1, alpha = 4.0 * std::numbers::pi / 180.0;
  filming.X_CP.linear() =
      (Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(-0.07, Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  filming.marker_height_m = 0.01;
  filming.lens->distortion = {-0.1, 0.02, 1e-3, -5e-4, 0.0};
  const double slope = 0.02;  // of the line of motion across the pattern's X
  filming.along_P = Eigen::Vector3d(std::cos(slope), std::sin(slope), 0.0);
  filming.through_P = Eigen::Vector3d(0.0, 0.03, -filming.marker_height_m);
  const Written twin = written("", {}, filming, alpha);
  REQUIRE(twin.view.pattern);
  CHECK(std::abs(twin.view.pattern->rotation_rad - slope) < 1e-9);
  const auto calibrated = [&](const Eigen::Vector3d& p_P) {
    const Eigen::Vector3d p = filming.X_CP * p_P;
    const cv::Point2d pixel = filming.lens->to_pixel({p.x() / p.z(), p.y() / p.z()});
    return Eigen::Vector2d(pixel.x, pixel.y);
  };
  for (const double x : {-0.2, 0.0, 0.25}) {
    const Eigen::Vector3d there(x * std::cos(alpha), -x * std::sin(alpha), filming.marker_height_m);
    const auto seen = render::project(twin.scenario.camera, there);
    REQUIRE(seen);
    // Nine figures of the file's numbers: 1e-6 px.
    CHECK((*seen - calibrated(filming.through_P + (x + kReference_m) * filming.along_P)).norm() < 1e-5);
  }
  CHECK(twin.scenario.pattern.inner_columns == 7);
  CHECK(twin.scenario.pattern.square_m == 0.02);
  // The pattern's middle, along and across the track from the reference point.
  const Eigen::Vector3d middle_W(twin.view.pattern->x_m * std::cos(alpha) + twin.view.pattern->y_m * std::sin(alpha),
                                 -twin.view.pattern->x_m * std::sin(alpha) + twin.view.pattern->y_m * std::cos(alpha),
                                 0.0);
  CHECK((*render::project(twin.scenario.camera, middle_W) - calibrated({0.06, 0.03, 0.0})).norm() < 1e-5);
}

TEST_CASE("a twin of what one scale restitutes sees the marker where the pixels were") {
  diagnose::Filming filming = filmed();
  filming.lens.reset();
  filming.inner_columns = filming.inner_rows = 0;
  filming.through_px = {300.0, 100.0};
  filming.along_px_m = {480.0, 30.0};
  const double alpha = 3.0 * std::numbers::pi / 180.0;
  const Written twin = written("", {}, filming, alpha);
  for (const double x : {-0.2, 0.0, 0.25}) {
    const auto seen = render::project(twin.scenario.camera, {x * std::cos(alpha), -x * std::sin(alpha), 0.0});
    REQUIRE(seen);
    CHECK((*seen - (filming.through_px + (x + kReference_m) * filming.along_px_m)).norm() < 1e-5);
  }
}

TEST_CASE("a twin's sensor makes the noise that was seen at each brightness", "[twin]") {
  constexpr double kWell_e = 12000.0, kRead_e = 25.0;
  diagnose::Filming filming = filmed();
  const double gain = 253.0 / kWell_e;
  filming.noise = diagnose::NoiseLaw{gain, 1e-4 * gain, gain * gain * kRead_e * kRead_e - 2.0 * gain + 1.0 / 12.0};
  const Written twin = written("", {}, filming);
  CHECK(twin.scenario.sensor.full_well_e == Approx(kWell_e).epsilon(1e-4));
  CHECK(twin.scenario.sensor.read_noise_e == Approx(kRead_e).epsilon(1e-4));
  filming.noise->gain_sd = gain;  // one brightness: light's noise alone, of the wall
  CHECK(written("", {}, filming).scenario.sensor.read_noise_e == 0.0);
}
