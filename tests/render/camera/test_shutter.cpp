#include "render/camera/frame_clock.h"

#include <fmt/format.h>

#include <cmath>

#include "base/files/file_io.h"
#include "render/film/clip_renderer.h"
#include "render/film/truth_files.h"
#include "render/scenario/scene.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

constexpr double kSpeed = 1.0;     // m/s, constant: no force on a level track
constexpr double kPxPerM = 600.0;  // the camera looks square on
constexpr double kPxPerS = kSpeed * kPxPerM;
constexpr double kRate = 50.0;
// px²: what the painter adds to the second moments of a resting marker of R = 6 px, whose radius is good to 0.01 px
// (2 R dR / 4).
constexpr double kVariance = 0.03;

/// A marker of 6 px radius at constant speed from x = -0.4 m on a level track, before black. `y_m` is the height of the
/// camera over it, in the image `kPxPerM * y_m` rows.
Scenario moving_marker(const std::string& sections, double y_m = 0.0) {
  const tests::TempDir dir;
  const std::string text = fmt::format(
      "format = 1\nname = \"t\"\n[camera]\nframe_rate_hz = {}\nwidth_px = 800\nheight_px = 600\nfocal_px = [1200.0, "
      "1200.0]\ncenter_px = [399.5, 299.5]\nposition_m = [0.0, {}, 2.0]\ntarget_m = [0.0, {}, 0.0]\n{}\n"
      "[calibration]\ninner_corners = [4, 3]\nsquare_m = 0.05\nviews = 3\nplane_y_m = {}\n"
      "[marker]\ndiameter_m = 0.02\n[scene]\nglider_albedo = 0.0\nlight_falloff = 0.0\n"
      "[[configuration]]\nname = \"m\"\nmass_kg = 0.3\nincline_deg = 0.0\n[[configuration.clip]]\nname = \"c\"\n"
      "launched = \"down\"\nx0_m = -0.4\nv0_m_s = {}\nduration_s = 0.8\n",
      kRate, y_m, y_m, sections, y_m, kSpeed);
  base::write_file(dir / "s.toml", text);
  return read_scenario(dir / "s.toml");
}

struct Moments {
  double sum = 0.0, u = 0.0, v = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;  // the last three central
};

struct Seen {
  std::size_t frame = 0;
  MarkerInImage truth;
  Moments moments;
};

/// Of the marker alone: within 14 px of it; the glider's magnets begin at 20 px.
Moments moments_of(const FloatImage& image, const PixelRect& near) {
  Moments m;
  const auto each = [&](const auto& add) {
    for (int y = near.y; y < near.y + near.height; ++y) {
      for (int x = near.x; x < near.x + near.width; ++x) add(static_cast<double>(image.at(x, y)), x, y);
    }
  };
  each([&](double value, int x, int y) {
    m.sum += value;
    m.u += value * x;
    m.v += value * y;
  });
  m.u /= m.sum;
  m.v /= m.sum;
  each([&](double value, int x, int y) {
    m.uu += value * (x - m.u) * (x - m.u) / m.sum;
    m.uv += value * (x - m.u) * (y - m.v) / m.sum;
    m.vv += value * (y - m.v) * (y - m.v) / m.sum;
  });
  return m;
}

/// All frames that have the glider's middle well in the image.
std::vector<Seen> frames_of(const Scenario& scenario) {
  const sim::ConfigurationSetup& configuration = scenario.motion.configurations.front();
  const RayTable rays = make_ray_table(scenario.camera);
  const StaticScene scene = empty_track(scenario, 0.0);
  const FloatImage black(scenario.camera.width_px, scenario.camera.height_px);
  ClipRenderer renderer(scenario, configuration, scene, rays, black, 1, 0);
  std::vector<Seen> seen;
  const auto visit = [&](const FrameMotion& frame) {
    const auto marker = marker_in_image(scenario, configuration.body, frame);
    if (!marker || !in_image(scenario.camera, marker->center_px, 30.0)) return;
    constexpr int kReach = 14;
    const PixelRect near{static_cast<int>(std::lround(marker->center_px.x())) - kReach,
                         static_cast<int>(std::lround(marker->center_px.y())) - kReach, 2 * kReach + 1, 2 * kReach + 1};
    seen.push_back({frame.frame, *marker, moments_of(renderer.expected(frame, near), near)});
  };
  for_each_frame(configuration.body, configuration.motions.front(), scenario.recording, renderer.longest_step_m(),
                 visit, renderer.detail());
  return seen;
}

/// The second moments of the resting marker's image at this place: those of the ellipse that a sphere is seen as, a
/// quarter of its half axes squared, and 1/12 of the pixels' squares.
Eigen::Matrix2d resting(const Scenario& scenario, const Seen& seen) {
  const Eigen::Vector3d c = scenario.camera.X_WC.inverse() * marker_position_W(scenario, 0.0, seen.truth.x_m);
  const Ellipse ellipse = image_of_sphere(c, 0.5 * scenario.marker.diameter_m).value();
  const double focal2 = scenario.camera.focal_px.x() * scenario.camera.focal_px.x();
  return 0.25 * focal2 * (ellipse.axis_u * ellipse.axis_u.transpose() + ellipse.axis_v * ellipse.axis_v.transpose()) +
         Eigen::Matrix2d::Identity() / 12.0;
}

}  // namespace

TEST_CASE("A row is exposed later the farther it is from the first one") {
  const Shutter top{true, 1e-5, false, 600};
  CHECK(std::abs(top.delay_s(599) - 599e-5) < 1e-15);
  CHECK(top.delay_s(0) == 0.0);
  const Shutter bottom{true, 1e-5, true, 600};
  CHECK(bottom.delay_s(599) == 0.0);
  CHECK(std::abs(bottom.delay_s(0) - bottom.readout_s()) < 1e-15);
}

TEST_CASE("A marker at constant speed is smeared by v T f / Z, about its place at mid-exposure") {
  // The variance along the motion is the resting marker's plus (v T f / Z)²/12. The instants have the exact second
  // moment; from 2 px on kVariance is less than 1 % of a smear.
  for (const double exposure_s : {0.0005, 0.002, 0.005, 0.015}) {
    const double smear_px = kPxPerS * exposure_s;
    const Scenario scenario = moving_marker(fmt::format("exposure_s = {}", exposure_s));
    const auto seen = frames_of(scenario);
    REQUIRE(seen.size() > 20);
    for (const Seen& frame : seen) {
      const Moments& m = frame.moments;
      const double still = resting(scenario, frame)(0, 0);
      CAPTURE(exposure_s, frame.frame, smear_px);
      const double x_m = -0.4 + kSpeed * (static_cast<double>(frame.frame) / kRate + 0.5 * exposure_s);
      CHECK(std::abs(frame.truth.center_px.x() - (399.5 + kPxPerM * x_m)) < 1e-6);
      CHECK(std::abs(m.u - (399.5 + kPxPerM * x_m)) < 0.01);
      CHECK(std::abs(m.v - 299.5) < 0.01);
      CHECK(std::abs(m.uu - still - smear_px * smear_px / 12.0) < kVariance);
      if (smear_px > 2.0) CHECK(std::abs(std::sqrt(12.0 * (m.uu - still)) / smear_px - 1.0) < 0.01);
    }
  }
}

TEST_CASE("A rolling shutter shifts and shears a marker that moves along the rows") {
  // Row r sees the marker v (T/2 + L i) farther, i counted from the first row: the centre is shifted by v L i(v_c) and
  // the image sheared by v L px a row. The marker lies 90 rows below the middle. Tolerances as above.
  constexpr double kLine = 3e-5;
  constexpr double kExposure = 0.002;
  for (const bool bottom : {false, true}) {
    const Scenario scenario = moving_marker(
        fmt::format("exposure_s = {}\n[shutter]\nkind = \"rolling\"\nline_readout_s = {}\nfirst_row = \"{}\"",
                    kExposure, kLine, bottom ? "bottom" : "top"),
        0.15);
    const auto seen = frames_of(scenario);
    REQUIRE(seen.size() > 20);
    for (const Seen& frame : seen) {
      const Moments& m = frame.moments;
      CAPTURE(bottom, frame.frame);
      const double row = 299.5 + 0.15 * kPxPerM;
      const double delay_s = kLine * (bottom ? 599.0 - row : row);
      const double sim_s = static_cast<double>(frame.frame) / kRate + 0.5 * kExposure + delay_s;
      CHECK(std::abs(frame.truth.center_px.x() - (399.5 + kPxPerM * (-0.4 + kSpeed * sim_s))) < 1e-6);
      CHECK(std::abs(frame.truth.center_px.y() - row) < 1e-6);
      // The clock of the frames: k / rate is the middle row's mid-exposure.
      const double middle_s = static_cast<double>(frame.frame) / kRate + 0.5 * kExposure + kLine * 299.5;
      CHECK(std::abs(frame.truth.t_s - (static_cast<double>(frame.frame) / kRate + sim_s - middle_s)) < 1e-12);
      CHECK(std::abs(m.u - frame.truth.center_px.x()) < 0.01);
      CHECK(std::abs(m.v - row) < 0.01);
      const double shear = (bottom ? -1.0 : 1.0) * kPxPerS * kLine;  // 0.018 px a row
      const Eigen::Matrix2d still = resting(scenario, frame);
      CHECK(std::abs((m.uv - still(0, 1)) / m.vv - shear) < 5e-4);
      CHECK(std::abs(m.vv - still(1, 1)) < kVariance);
    }
  }
}

TEST_CASE("In portrait a rolling shutter stretches a marker that moves with the rows and shortens one against them") {
  // Turned by 90 degrees the track's +x is up in the image: v(t) = 299.5 - px/m x(t). The centre is on the row that
  // is read when it is there: r = v0 - w (t0 + L i(r)), linear in r; the height changes by dr/dv0.
  constexpr double kLine = 3e-5;
  constexpr double kExposure = 0.0005;
  for (const bool bottom : {false, true}) {
    const Scenario scenario = moving_marker(
        fmt::format("roll_deg = 90.0\nexposure_s = {}\n[shutter]\nkind = \"rolling\"\nline_readout_s = {}\nfirst_row = "
                    "\"{}\"",
                    kExposure, kLine, bottom ? "bottom" : "top"));
    const auto seen = frames_of(scenario);
    REQUIRE(seen.size() > 20);
    for (const Seen& frame : seen) {
      const Moments& m = frame.moments;
      CAPTURE(bottom, frame.frame);
      const double t0 = static_cast<double>(frame.frame) / kRate + 0.5 * kExposure;
      const double v0 = 299.5 - kPxPerM * (-0.4 + kSpeed * t0);
      const double along = kPxPerS * kLine;
      const double row = bottom ? (v0 - along * 599.0) / (1.0 - along) : v0 / (1.0 + along);
      CHECK(std::abs(frame.truth.center_px.y() - row) < 1e-6);
      CHECK(std::abs(m.v - row) < 0.01);
      CHECK(std::abs(m.u - 399.5) < 0.01);
      const double still = resting(scenario, frame)(1, 1);
      const double stretch = bottom ? 1.0 / (1.0 - along) : 1.0 / (1.0 + along);
      const double smear = kPxPerS * kExposure;
      // What a row shows is the body smeared by its exposure, then stretched.
      CHECK(std::abs(m.vv - stretch * stretch * (still + smear * smear / 12.0)) < kVariance);
    }
  }
}
