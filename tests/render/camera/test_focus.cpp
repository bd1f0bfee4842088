#include "render/camera/optics.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "render/film/truth_files.h"
#include "tests/catch.h"
#include "tests/render/made_clip.h"

using namespace glidelab;
using namespace glidelab::render;
using namespace glidelab::render::tests;

namespace {

/// The part of a pixel, at the signed distance `d` px inside a straight edge with the normal `n`, that shows the inner
/// side: the probability that a point of disc, Gaussian and square together lies inside. The disc's marginal is
/// 1/2 + (x sqrt(1 - x²) + asin x)/pi; Gaussian and square by midpoints, good to 1e-4.
double edge_spread(double d, const Eigen::Vector2d& n, double disc_px, double sigma_px) {
  const auto disc = [&](double x) {
    if (disc_px < 1e-9) return x > 0.0 ? 1.0 : 0.0;
    const double s = std::clamp(x / disc_px, -1.0, 1.0);
    return 0.5 + (s * std::sqrt(1.0 - s * s) + std::asin(s)) / std::numbers::pi;
  };
  constexpr int kSquare = 24;
  constexpr int kNormal = 81;
  double sum = 0.0;
  double weights = 0.0;
  for (int k = 0; k < kNormal; ++k) {
    const double z = -4.0 + 8.0 * (k + 0.5) / kNormal;
    const double weight = std::exp(-0.5 * z * z);
    weights += weight;
    for (int i = 0; i < kSquare; ++i) {
      for (int j = 0; j < kSquare; ++j) {
        const double within = n.x() * ((i + 0.5) / kSquare - 0.5) + n.y() * ((j + 0.5) / kSquare - 0.5);
        sum += weight * disc(d + within + sigma_px * z);
      }
    }
  }
  return sum / (weights * kSquare * kSquare);
}

Focus lens(double f_number, double focus_distance_m, double core_px = 0.0) {
  Focus focus;
  focus.f_number = f_number;
  focus.focus_distance_m = focus_distance_m;
  focus.pixel_pitch_m = 5e-6;
  focus.core_px = core_px;
  return focus;
}

Camera slanted_camera() {
  Camera camera;
  camera.width_px = 240;
  camera.height_px = 180;
  camera.focal_px = {1200.0, 1200.0};
  camera.center_px = {119.5, 89.5};
  camera.X_WC = look_at({0.0, 0.0, 2.0}, {0.0, 0.0, 0.0}, 0.09);
  return camera;
}

}  // namespace

TEST_CASE("The disc is the thin lens's circle of confusion, the core that of diffraction") {
  // Sensor distance s = 1200 * 5 µm = 6 mm; f = s d/(s + d); diameter on the sensor f²/N |Z - d| / (Z (d - f)).
  const Camera camera = slanted_camera();
  const Focus focus = lens(1.8, 3.0, 0.0);
  const double s = 0.006;
  const double f = s * 3.0 / (s + 3.0);
  for (const double depth_m : {0.5, 2.0, 3.0, 10.0}) {
    const double diameter_m = f * f / 1.8 * std::abs(depth_m - 3.0) / (depth_m * (3.0 - f));
    CHECK(std::abs(2.0 * disc_radius_px(focus, camera, depth_m) - diameter_m / 5e-6) < 1e-9);
  }
  CHECK(std::abs(core_sigma_px(focus, camera) - 0.42 * 550e-9 * 1.8 * (s / f) / 5e-6) < 1e-12);
  CHECK(std::abs(core_sigma_px(lens(1.8, 3.0, 0.5), camera) - std::hypot(core_sigma_px(focus, camera), 0.5)) < 1e-12);
}

TEST_CASE("The lens's samples have the mean and the covariance of what they stand for") {
  for (const std::size_t count : {std::size_t{16}, std::size_t{64}, std::size_t{256}}) {
    Eigen::Vector4d mean = Eigen::Vector4d::Zero();
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    double largest = 0.0;
    for (const FocusSample& sample : focus_samples(count)) {
      Eigen::Vector4d all;
      all << sample.aperture, sample.core;
      mean += all / static_cast<double>(count);
      covariance += all * all.transpose() / static_cast<double>(count);
      largest = std::max(largest, sample.aperture.norm());
    }
    CHECK(mean.norm() < 1e-14);
    CHECK(std::abs(covariance(0, 0) - 0.25) < 1e-12);
    CHECK(std::abs(covariance(1, 1) - 0.25) < 1e-12);
    CHECK(std::abs(covariance(0, 1)) < 1e-12);
    CHECK(std::abs(covariance(2, 2) - 1.0) < 1e-12);
    CHECK(std::abs(covariance(3, 3) - 1.0) < 1e-12);
    CHECK(largest < 1.2);  // stretched by the exact covariance, for 16 samples most
  }
}

TEST_CASE("A board's edge that is out of focus spreads as theory says") {
  // Depth 2 m, square on. 256 rays, the same in each pixel: within 0.05 of the contrast anywhere, and 0.008 rms.
  const Camera camera = slanted_camera();
  const RayTable rays = make_ray_table(camera);
  StaticScene scene;
  scene.wall_albedo = 0.0;
  scene.light_falloff = 0.0;
  scene.board = Chessboard{};
  scene.board->inner_columns = 3;
  scene.board->inner_rows = 3;
  scene.board->square_m = 0.05;  // 30 px
  scene.board->white_albedo = 1.0;
  scene.board->black_albedo = 0.0;
  scene.board->X_WP.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  scene.board->X_WP.translation() = Eigen::Vector3d(-0.05, 0.05, 0.0);
  for (const Focus& focus : {lens(1.4, 2.0, 0.6), lens(1.4, 1.5), lens(1.0, 1.2, 0.3), lens(1.0, 1.0)}) {
    const FloatImage image = StaticPainter(camera, rays, focus).paint(scene);
    const double disc = disc_radius_px(focus, camera, 2.0);
    const double sigma = core_sigma_px(focus, camera);
    // The edge at X = 0 between the inner corners (0, 0) and (0, 1): black on one side, white on the other.
    const auto pixel = [&](double X, double Y) {
      return project(camera, scene.board->X_WP * Eigen::Vector3d(0.05 * X, 0.05 * Y, 0.0)).value();
    };
    const Eigen::Vector2d middle = pixel(0.0, 0.5);
    const Eigen::Vector2d normal = (pixel(1.0, 0.5) - middle).normalized();
    const double bright = static_cast<double>(image.at(static_cast<int>(std::lround(pixel(0.5, 0.5).x())),
                                                       static_cast<int>(std::lround(pixel(0.5, 0.5).y()))));
    const double other = static_cast<double>(image.at(static_cast<int>(std::lround(pixel(-0.5, 0.5).x())),
                                                      static_cast<int>(std::lround(pixel(-0.5, 0.5).y()))));
    double worst = 0.0, squares = 0.0;
    int count = 0;
    for (int y = static_cast<int>(middle.y()) - 4; y <= static_cast<int>(middle.y()) + 4; ++y) {
      for (int x = static_cast<int>(middle.x()) - 10; x <= static_cast<int>(middle.x()) + 10; ++x) {
        const double d = (Eigen::Vector2d(x, y) - middle).dot(normal);
        const double expected = other + (bright - other) * edge_spread(d, normal, disc, sigma);
        const double error = std::abs(static_cast<double>(image.at(x, y)) - expected) / std::abs(bright - other);
        worst = std::max(worst, error);
        squares += error * error;
        ++count;
      }
    }
    CAPTURE(disc, sigma, bright, other, worst, std::sqrt(squares / count));
    CHECK(std::abs(bright - other) > 0.5);
    CHECK(worst < 0.05);
    CHECK(std::sqrt(squares / count) < 0.008);
  }
}

TEST_CASE("The glider's edge spreads likewise, and its marker keeps its centre") {
  // The carriage's right side at 2 m, between its chamfer and its magnets; before black. The samples lie a quarter of a
  // pixel apart across the edge: within 0.04 of the contrast anywhere, and 0.01 rms.
  for (const double focus_m : {2.0, 1.5, 1.2}) {
    const MadeClip clip(scenario_of(fmt::format(
        "[camera]\nwidth_px = 640\nheight_px = 200\nframe_rate_hz = 100.0\nexposure_s = 1e-6\nfocal_px = [1200.0, "
        "1200.0]\nposition_m = [0.0, 0.0, 2.0]\nroll_deg = 5.0\n[focus]\nf_number = 1.4\nfocus_distance_m = {}\n"
        "pixel_pitch_m = 5e-6\ncore_px = 0.3\n[calibration]\ninner_corners = [4, 3]\nsquare_m = 0.02\nviews = 3\n"
        "[marker]\ndiameter_m = 0.014\n[scene]\nwall_albedo = 0.0\ntrack_albedo = 0.0\nglider_albedo = 0.6\n"
        "light_falloff = 0.0\n[[configuration]]\nname = \"m\"\nmass_kg = 0.3\nincline_deg = 0.0\n"
        "[[configuration.clip]]\nname = \"c\"\nlaunched = \"down\"\nx0_m = 0.03\nv0_m_s = 0.1\nduration_s = 0.05\n",
        focus_m)));
    clip.each_frame([&](const FrameMotion& frame, ClipRenderer& renderer) {
      const FloatImage& image = renderer.expected(frame);
      const Camera& camera = clip.scenario.camera;
      const MovingBox box = glider(clip.scenario, clip.scene, clip.configuration.body, frame.middle.x_m).boxes.front();
      const auto pixel = [&](double along, double up_m) {
        const Eigen::Vector3d p =
            box.center_W + Eigen::Vector3d(frame.middle.x_m + along * box.half_m.x(), 0.0, box.half_m.z());
        return project(camera, {p.x(), up_m, p.z()}).value();
      };
      const double depth = 2.0 - (box.center_W.z() + box.half_m.z());
      const double disc = disc_radius_px(*clip.scenario.focus, camera, depth);
      const double sigma = core_sigma_px(*clip.scenario.focus, camera);
      const Eigen::Vector2d middle = pixel(1.0, 0.003);
      Eigen::Vector2d normal(pixel(1.0, 0.01).y() - middle.y(), -(pixel(1.0, 0.01).x() - middle.x()));
      normal.normalize();
      const double inside = electrons_of_white(clip.scenario) * box.radiance[5];
      double worst = 0.0, squares = 0.0;
      int count = 0;
      for (int y = static_cast<int>(middle.y()) - 2; y <= static_cast<int>(middle.y()) + 2; ++y) {
        for (int x = static_cast<int>(middle.x()) - 8; x <= static_cast<int>(middle.x()) + 8; ++x) {
          const double d = (Eigen::Vector2d(x, y) - middle).dot(normal);
          const double error = static_cast<double>(image.at(x, y)) / inside - edge_spread(d, normal, disc, sigma);
          worst = std::max(worst, std::abs(error));
          squares += error * error;
          ++count;
        }
      }
      CAPTURE(focus_m, frame.frame, disc, sigma, worst, std::sqrt(squares / count));
      CHECK(worst < 0.04);
      CHECK(std::sqrt(squares / count) < 0.01);
      // The marker over the body, which is even around it: its centroid, less the body.
      const MarkerInImage truth = marker_in_image(clip.scenario, clip.configuration.body, frame).value();
      double sum = 0.0;
      Eigen::Vector2d moment = Eigen::Vector2d::Zero();
      const int u = static_cast<int>(std::lround(truth.center_px.x()));
      const int v = static_cast<int>(std::lround(truth.center_px.y()));
      for (int y = v - 6; y <= v + 6; ++y) {
        for (int x = u - 8; x <= u + 8; ++x) {
          const double more = static_cast<double>(image.at(x, y)) - inside;
          sum += more;
          moment += more * Eigen::Vector2d(x, y);
        }
      }
      if (disc < 2.0) CHECK((moment / sum - truth.centroid_px).norm() < 0.015);
    });
  }
}
