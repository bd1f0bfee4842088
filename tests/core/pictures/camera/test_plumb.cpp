#include "core/pictures/camera/plumb.h"

#include <cmath>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "base/errors.h"
#include "tests/catch.h"
#include "tests/core/known_camera.h"
#include "tests/core/notes.h"
#include "tests/core/painter.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::KnownCamera;
using tests::KnownPlane;

namespace {

const KnownCamera kCamera{.fx = 415.0, .fy = 414.0, .cx = 203.0, .cy = 147.0, .size = {400, 300}};

/// The wall, 1.6 m before a camera that looks at it from the side and is rolled; its Y axis hangs down.
KnownPlane wall() {
  return tests::known_plane({0.05, -0.02, 1.6}, 0.08, -0.15, 0.03, 0.16, 0.10);
}

core::Restitution restitution() {
  core::Calibration calibration;
  calibration.camera = {
      kCamera.fx,  kCamera.fy, kCamera.cx, kCamera.cy, {kCamera.k1, kCamera.k2, kCamera.p1, kCamera.p2, 0.0},
      kCamera.size};
  cv::RNG random(1);
  return core::Restitution::from_pattern(calibration, {tests::known_corners(kCamera, wall(), 0.04, 0.0, random)}, 0.04,
                                         0.02, 0.02);
}

/// A thread from (x, top) that hangs straight down along the plane's Y, `off` before the plane; painted as the distance
/// of each pixel from its projected, finely divided course.
cv::Mat image_of(double x, double off, double half_width_px, double value, std::uint64_t seed) {
  std::vector<cv::Point2d> course;
  for (int k = 0; k <= 400; ++k) course.push_back(kCamera.project(wall().at(x, -0.45 + 0.0025 * k, -off)));
  const auto distance = [&](double u, double v) {
    // The course runs down the image: the piece at this row.
    std::size_t k = 0;
    while (k + 2 < course.size() && course[k + 1].y < v) ++k;
    const cv::Point2d direction = (course[k + 1] - course[k]) / cv::norm(course[k + 1] - course[k]);
    return std::abs(direction.cross(cv::Point2d(u, v) - course[k]));
  };
  const cv::Mat image = tests::paint(
      kCamera.size,
      [&](double u, double v) {
        const double background = 90.0 + 0.1 * u + (u > 262.0 ? 40.0 : 0.0);  // a slope, and an upright edge
        const bool inside = course.front().y < v && course.back().y > v && distance(u, v) < half_width_px;
        return inside ? value : background;
      },
      4, 0.5);
  return tests::expose(image, 2.0, seed);
}

core::MotionAxis axis_at(double alpha_rad) {
  std::vector<cv::Point2d> points;
  for (int k = 0; k < 100; ++k) points.emplace_back(0.01 * k * std::cos(alpha_rad), 0.01 * k * std::sin(alpha_rad));
  return core::MotionAxis::through(points, core::Downhill::plus_x);
}

}  // namespace

TEST_CASE("the inclination against a plumb line comes out within its uncertainty, wherever and however it hangs") {
  const tests::TempDir dir;
  const double alpha_deg = 4.0;
  const double alpha = alpha_deg * std::numbers::pi / 180.0;
  struct Hanging {
    double x, off, half_width_px, value;
  };
  std::uint64_t seed = 1;
  for (const Hanging h :
       {Hanging{0.25, 0.0, 0.6, 20.0}, Hanging{0.25, 0.03, 0.6, 230.0}, Hanging{-0.2, -0.05, 1.5, 30.0}}) {
    cv::imwrite((dir / "plumb.png").string(), image_of(h.x, h.off, h.half_width_px, h.value, seed++));
    const cv::Point2d middle = kCamera.project(wall().at(h.x, 0.0));
    const core::PixelRegion region{static_cast<int>(middle.x) - 30, 10, 60, 270};
    const auto found = core::plumb_angle({dir / "plumb.png", region}, restitution(), axis_at(alpha), kCamera.size);
    REQUIRE(found.estimate);
    INFO("x " << h.x << ", off " << h.off << ": " << found.estimate->value << " sd " << found.estimate->sd);
    // About 200 rows at 0.03 px over lever arms of 60 px rms: 4e-5 rad, 0.002 degrees.
    CHECK(found.estimate->sd < 0.02);
    CHECK(std::abs(found.estimate->value - alpha_deg) < 4.0 * found.estimate->sd + 0.004);
    // Uphill the other way.
    const auto negative = core::plumb_angle({dir / "plumb.png", region}, restitution(), axis_at(-alpha), kCamera.size);
    CHECK(std::abs(negative.estimate->value + alpha_deg) < 4.0 * found.estimate->sd + 0.004);
  }
}

TEST_CASE("a thread that lies across the image is found as the one of the image turned on its diagonal") {
  const cv::Mat upright = image_of(0.25, 0.0, 0.6, 20.0, 1);
  const cv::Point2d middle = kCamera.project(wall().at(0.25, 0.0));
  const cv::Rect region(static_cast<int>(middle.x) - 30, 17, 60, 250);
  const auto no_lens = [](cv::Point2d pixel) { return std::optional(pixel); };
  const core::ThreadInImage down = core::find_thread(upright, region, no_lens);
  const core::ThreadInImage across =
      core::find_thread(upright.t(), cv::Rect(region.y, region.x, region.height, region.width), no_lens);
  CHECK(down.rows > 100);
  CHECK(across.rows == down.rows);
  REQUIRE(across.points.size() == down.points.size());
  for (std::size_t k = 0; k < down.points.size(); ++k) {
    const cv::Point2d swapped(across.points[k].y, across.points[k].x);
    CHECK(cv::norm(swapped - down.points[k]) < 1e-6);  // the same arithmetic, but for rounding
  }
}

TEST_CASE("a region without a thread, or outside the image, is an error that names the file") {
  const tests::TempDir dir;
  cv::imwrite((dir / "plumb.png").string(), image_of(0.25, 0.0, 0.6, 20.0, 1));
  const auto error = [&](core::PixelRegion region) {
    try {
      core::plumb_angle({dir / "plumb.png", region}, restitution(), axis_at(0.0), kCamera.size);
    } catch (const base::InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK_THAT(error({20, 20, 60, 200}), Catch::Contains("plumb.png") && Catch::Contains("no thin straight line"));
  CHECK_THAT(error({380, 20, 60, 200}), Catch::Contains("plumb.png") && Catch::Contains("inside the image"));
}

TEST_CASE("an inclination is not determined where the marker does not move") {
  const tests::TempDir dir;
  cv::imwrite((dir / "plumb.png").string(), image_of(0.25, 0.0, 0.6, 20.0, 1));
  const cv::Point2d middle = kCamera.project(wall().at(0.25, 0.0));
  const core::PixelRegion region{static_cast<int>(middle.x) - 30, 10, 60, 270};
  const auto found = core::plumb_angle({dir / "plumb.png", region}, restitution(),
                                       core::MotionAxis::along(core::Downhill::plus_x), kCamera.size);
  CHECK_FALSE(found.estimate);
  CHECK(tests::reason_of<core::unknown::NoLineOfMotion>(found) != nullptr);
}
