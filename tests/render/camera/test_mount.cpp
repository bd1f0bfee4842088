#include "render/camera/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "render/film/truth_files.h"
#include "tests/catch.h"
#include "tests/render/made_clip.h"

using namespace glidelab;
using namespace glidelab::render;
using namespace glidelab::render::tests;

namespace {

std::string text(const std::string& mount, const std::string& camera = "") {
  return fmt::format(
      "{}\n[camera]\nwidth_px = 320\nheight_px = 240\nframe_rate_hz = 100.0\nexposure_s = 0.0005\nfocal_px = [400.0, "
      "402.0]\nposition_m = [0.05, 0.1, 2.2]\ndistortion = {{ k1 = -0.1, p1 = 0.001 "
      "}}\n{}\n[calibration]\ninner_corners "
      "= [4, 3]\nsquare_m = 0.05\nviews = 3\n[marker]\ndiameter_m = 0.05\n[[configuration]]\nname = \"m\"\n"
      "mass_kg = 0.3\nincline_deg = 0.0\n[[configuration.clip]]\nname = \"c\"\nlaunched = \"down\"\nx0_m = -0.1\n"
      "v0_m_s = 0.5\nduration_s = 0.1\n",
      mount, camera);
}

/// The camera as it stands at an instant.
Camera moved_camera(const Scenario& scenario, double t_s) {
  Camera camera = scenario.camera;
  camera.X_WC = camera.X_WC * mount_at(scenario.mount, t_s);
  return camera;
}

struct Difference {
  double rms = 0.0;
  double largest = 0.0;
};

Difference difference(const FloatImage& a, const FloatImage& b) {
  Difference found;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double d = std::abs(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i]));
    found.rms += d * d / static_cast<double>(a.values.size());
    found.largest = std::max(found.largest, d);
  }
  found.rms = std::sqrt(found.rms);
  return found;
}

}  // namespace

TEST_CASE("A mount's motions add up along and about the camera's own axes") {
  Mount mount;
  mount.motions = {{MountAxis::x, 0.1, 0.2, 0.0, 0.0, 0.0},
                   {MountAxis::x, 0.0, 0.0, 0.01, 5.0, std::numbers::pi / 2.0},
                   {MountAxis::roll, 0.3, 0.0, 0.0, 0.0, 0.0}};
  const Eigen::Isometry3d moved = mount_at(mount, 0.1);
  CHECK((moved.translation() - Eigen::Vector3d(0.1 + 0.02 + 0.01 * std::cos(std::numbers::pi), 0, 0)).norm() < 1e-12);
  CHECK((moved.linear().col(0) - Eigen::Vector3d(std::cos(0.3), std::sin(0.3), 0.0)).norm() < 1e-12);
  mount.motions = {{MountAxis::pan, 0.2, 0.0, 0.0, 0.0, 0.0}};
  // The optical axis turns to the right.
  CHECK((mount_at(mount, 3.0).linear().col(2) - Eigen::Vector3d(std::sin(0.2), 0.0, std::cos(0.2))).norm() < 1e-12);
}

TEST_CASE("What stands still is drawn as a camera that stands there casts it") {
  // Radiance goes up to 0.6. The image between fine places is taken as linear: where an edge along the rows enters a
  // pixel that errs by up to 1/16 of its contrast, and an image cast again with 64 rays by as much as 1/64 each.
  struct Case {
    const char* mount;
    double rms, largest;
  };
  const Case cases[] = {
      {"[[mount.motion]]\naxis = \"pan\"\namplitude_deg = 0.3\nfrequency_hz = 12.0\n", 2e-3, 0.05},
      {"[[mount.motion]]\naxis = \"roll\"\ndrift_deg_s = 5.0\n[[mount.motion]]\naxis = \"tilt\"\noffset_deg = 0.4\n",
       2e-3, 0.05},
      // Sideways by up to 5 mm: parallax of 0.3 px between track and wall, guessed at the edges between them.
      {"[[mount.motion]]\naxis = \"x\"\namplitude_m = 0.005\nfrequency_hz = 9.0\n", 5e-3, 0.2},
      {"[[mount.motion]]\naxis = \"z\"\ndrift_m_s = 0.1\n", 5e-3, 0.2},
  };
  for (const Case& one : cases) {
    const MadeClip clip(scenario_of(text(one.mount)));
    const double white_e = electrons_of_white(clip.scenario);
    for (const double t_s : {0.061}) {
      const Camera there = moved_camera(clip.scenario, t_s);
      FloatImage cast = StaticPainter(there, make_ray_table(there)).paint(clip.scene);
      FloatImage drawn(320, 240);
      for (int y = 0; y < 240; ++y) {
        add_row(*clip.fine, mount_at(clip.scenario.mount, t_s), y, 0, 1.0f, drawn.row(y, 0, 320));
      }
      const Difference found = difference(cast, drawn);
      const Difference unmoved = difference(cast, StaticPainter(clip.scenario.camera, clip.rays).paint(clip.scene));
      CAPTURE(one.mount, t_s, found.rms, found.largest, unmoved.rms, white_e);
      CHECK(found.rms < one.rms);
      CHECK(found.largest < one.largest);
      CHECK(unmoved.rms > 1.5 * found.rms);
    }
  }
}

TEST_CASE("The marker moves with the mount, and the truth says where it is") {
  // Drift and vibration in one; the photometric centre against the truth's centroid, to the painter's 0.01 px. All else
  // is black but the glider's magnets, which begin 7 px from the marker's centre; its radius is 4.5 px.
  const std::string black = "[scene]\nwall_albedo = 0.0\ntrack_albedo = 0.0\nglider_albedo = 0.0\n";
  for (const char* shutter : {"", "[shutter]\nkind = \"rolling\"\nline_readout_s = 3e-5\n"}) {
    const MadeClip clip(
        scenario_of(text(black + "[[mount.motion]]\naxis = \"tilt\"\namplitude_deg = 0.2\nfrequency_hz = "
                                 "31.0\n[[mount.motion]]\naxis = \"y\"\ndrift_m_s = 0.05\n",
                         shutter)));
    clip.each_frame([&](const FrameMotion& frame, ClipRenderer& renderer) {
      const FloatImage& image = renderer.expected(frame);
      const MarkerInImage truth = marker_in_image(clip.scenario, clip.configuration.body, frame).value();
      // The truth is the projection by the camera as it stands at that instant.
      const double sim_s = truth.t_s + 0.5 * 0.0005 + 0.5 * clip.scenario.recording.shutter.readout_s();
      const Eigen::Vector2d projected =
          project(moved_camera(clip.scenario, sim_s), marker_position_W(clip.scenario, 0.0, truth.x_m)).value();
      CHECK((projected - truth.center_px).norm() < 1e-6);
      CHECK(std::abs(truth.x_m - (-0.1 + 0.5 * sim_s)) < 1e-8);
      double sum = 0.0;
      Eigen::Vector2d moment = Eigen::Vector2d::Zero();
      const int u = static_cast<int>(std::lround(truth.center_px.x()));
      const int v = static_cast<int>(std::lround(truth.center_px.y()));
      for (int y = v - 5; y <= v + 5; ++y) {
        for (int x = u - 5; x <= u + 5; ++x) {
          sum += static_cast<double>(image.at(x, y));
          moment += static_cast<double>(image.at(x, y)) * Eigen::Vector2d(x, y);
        }
      }
      CAPTURE(shutter, frame.frame);
      CHECK((moment / sum - truth.centroid_px).norm() < 0.02);
    });
  }
}

TEST_CASE("A focus that was changed after the calibration enlarges the clips and not the boards") {
  const Scenario read = scenario_of(text("[mount]\nfocal_change = 0.01\n"));
  const Scenario clips = as_in_clips(read);
  CHECK((clips.camera.focal_px - 1.01 * read.camera.focal_px).norm() < 1e-9);
  const Eigen::Vector2d before = project(read.camera, {0.3, 0.0, 0.0}).value() - read.camera.center_px;
  const Eigen::Vector2d after = project(clips.camera, {0.3, 0.0, 0.0}).value() - read.camera.center_px;
  CHECK((after - 1.01 * before).norm() < 1e-9);
}

TEST_CASE("A mount that moves the image out of all reason is refused") {
  CHECK_THROWS_AS(MadeClip(scenario_of(text("[[mount.motion]]\naxis = \"pan\"\noffset_deg = 29.0\ndrift_deg_s = 30.0\n"
                                            "[[mount.motion]]\naxis = \"pan\"\noffset_deg = 29.0\n"))),
                  base::NumericalError);
}
