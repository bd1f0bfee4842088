#include "core/pictures/camera/restitution.h"

#include <cmath>
#include <numbers>

#include "tests/catch.h"
#include "tests/core/known_camera.h"

using namespace glidelab;
using tests::KnownCamera;
using tests::KnownPlane;

namespace {

core::Calibration exact(const KnownCamera& known) {
  core::Calibration calibration;
  calibration.camera = {known.fx,  known.fy, known.cx, known.cy, {known.k1, known.k2, known.p1, known.p2, known.k3},
                        known.size};
  return calibration;
}

/// A plane 1.6 m before the camera, seen at a slant, its X axis a little off the image's.
KnownPlane slanted() {
  return tests::known_plane({0.05, -0.02, 1.6}, 0.10, -0.20, 0.07, 0.16, 0.10);
}

}  // namespace

TEST_CASE("exact corners give the plane's points back to a nanometre, on the plane and off it") {
  const KnownCamera known;
  const KnownPlane plane = slanted();
  cv::RNG random(1);
  const auto corners = tests::known_corners(known, plane, 0.04, 0.0, random);
  for (const double height_m : {0.0, 0.035, -0.01}) {
    const auto restitution = core::Restitution::from_pattern(exact(known), {corners}, 0.04, height_m, 0.0);
    for (double x = -0.5; x < 0.9; x += 0.2) {
      for (double y = -0.4; y < 0.6; y += 0.2) {
        const auto found = restitution.to_plane(known.project(plane.at(x, y, -height_m)));
        REQUIRE(found);
        // Double rounding in the corners (1e-13 px) is amplified by the least-squares fit; 1e-9 m is 5e-7 px.
        CHECK(std::hypot(found->x - x, found->y - y) < 1e-9);
        CHECK(cv::norm(restitution.to_pixel({x, y}) - known.project(plane.at(x, y, -height_m))) < 1e-6);
      }
    }
    CHECK(restitution.plane()->rms_m < 1e-9);
  }
}

TEST_CASE("leaving the marker's height out would be seen") {
  const KnownCamera known;
  const KnownPlane plane = slanted();
  cv::RNG random(1);
  const auto corners = tests::known_corners(known, plane, 0.04, 0.0, random);
  const auto flat = core::Restitution::from_pattern(exact(known), {corners}, 0.04, 0.0, 0.0);
  // 35 mm at 1.6 m: 2.2 % of the distance from the axis, so 1 mm at the very least over most of the field.
  const auto found = flat.to_plane(known.project(plane.at(0.6, 0.1, -0.035)));
  CHECK(std::hypot(found->x - 0.6, found->y - 0.1) > 1e-3);
}

TEST_CASE("a plane view of a bent board does not agree with the camera, one of a flat board does") {
  const KnownCamera known;
  cv::RNG random(5);
  const double noise_px = 0.02;
  const core::Calibration calibration = core::calibrate_camera(tests::known_views(known, noise_px, random), 0.04);
  auto corners = tests::known_corners(known, slanted(), 0.04, noise_px, random);
  const auto said = [&] {
    const auto plane = core::fit_plane(calibration.camera, {corners}, 0.04, calibration.noise.correlated_px);
    return core::disagreement(plane, 1, calibration.noise, "level");
  };
  CHECK_FALSE(said());
  // A bow of 1 px from the middle to the ends of the longer row, of which a pose takes the mean: some 0.3 px are left.
  for (std::size_t i = 0; i < corners.points.size(); ++i) {
    const double along = (static_cast<double>(i % 9) - 4.0) / 4.0;
    corners.points[i].y += along * along;
  }
  const auto warning = said();
  REQUIRE(warning);
  CHECK(warning->group == "level");
  CHECK(warning->rms_px > 0.2);
  CHECK(warning->rms_px < 0.5);
}

TEST_CASE("the centre of a sphere's image is put right to a few micrometres") {
  // The oracle: rays over a fine grid of pixels, those that meet the sphere; their centroid is the centre of the image.
  const KnownCamera known{
      .fx = 500.0, .fy = 500.0, .k1 = 0.0, .k2 = 0.0, .p1 = 0.0, .p2 = 0.0};  // wide; no lens to undo
  const KnownPlane plane = tests::known_plane({0.0, 0.0, 1.0}, 0.0, 0.0, 0.0, 0.16, 0.10);
  cv::RNG random(1);
  const auto corners = tests::known_corners(known, plane, 0.04, 0.0, random);
  const double radius_m = 0.03;
  const auto corrected = core::Restitution::from_pattern(exact(known), {corners}, 0.04, 0.0, 2.0 * radius_m);
  const auto plain = core::Restitution::from_pattern(exact(known), {corners}, 0.04, 0.0, 0.0);
  const cv::Point2d place(0.76, 0.10);  // 0.6 m off the axis at 1 m
  const cv::Vec3d centre = plane.at(place.x, place.y);
  const cv::Point2d near = known.project(centre);
  const double grid = 0.02;
  cv::Point2d sum;
  double count = 0.0;
  for (double v = near.y - 25.0; v < near.y + 25.0; v += grid) {
    for (double u = near.x - 25.0; u < near.x + 25.0; u += grid) {
      const cv::Vec3d ray = cv::normalize(cv::Vec3d((u - known.cx) / known.fx, (v - known.cy) / known.fy, 1.0));
      const double along = ray.dot(centre);
      if (centre.dot(centre) - along * along > radius_m * radius_m) continue;
      sum += cv::Point2d(u, v);
      count += 1.0;
    }
  }
  const cv::Point2d seen = sum / count;
  // The correction is 0.4 mm here, of which the outline's 48 points miss 0.3 % = 1.3 um; the grid's rim (2 pi 15 / 0.02
  // cells, each wrong by half a cell at random) adds 0.02 um.
  CHECK(std::hypot(corrected.to_plane(seen)->x - place.x, corrected.to_plane(seen)->y - place.y) < 2e-6);
  CHECK(plain.to_plane(seen)->x - place.x > 3e-4);
  CHECK(cv::norm(corrected.to_pixel(place) - seen) < 1e-3);
  // The image's axes are R f / D / cos(angle) and that over cos again, roughly; here R f / Z and 1.17 times that.
  CHECK(std::abs(*corrected.marker_radius_px(seen) - 15.0) < 2.0);
}

TEST_CASE("the outlines of a sphere and of a disc off the axis are the ellipses that rays and the plane make") {
  const KnownCamera known{
      .fx = 500.0, .fy = 500.0, .k1 = 0.0, .k2 = 0.0, .p1 = 0.0, .p2 = 0.0};  // wide; no lens to undo
  const KnownPlane plane = tests::known_plane({0.0, 0.0, 1.0}, 0.0, 0.0, 0.0, 0.16, 0.10);
  cv::RNG random(1);
  const auto corners = tests::known_corners(known, plane, 0.04, 0.0, random);
  const double radius_m = 0.002;
  const auto restitution = core::Restitution::from_pattern(exact(known), {corners}, 0.04, 0.0, 2.0 * radius_m);
  const cv::Point2d place(0.76, 0.10);  // 0.6 m off the axis at 1 m
  const auto sphere = restitution.marker_shape(restitution.to_pixel(place));
  const auto disc = restitution.disc_shape(restitution.to_pixel(place));
  REQUIRE(sphere);
  REQUIRE(disc);
  // A small sphere at the depth Z = 1 m and the angle t off the axis: half axes R f / (Z cos t) outwards, R f / Z
  // across. What is left out is of the order (R / D)^2 = 3e-6 and, of the far side's scale, R tan t / D = 1e-3 at
  // either end.
  const double cosine = 1.0 / std::hypot(1.0, 0.6), across_px = radius_m * 500.0;
  CHECK(std::abs((*sphere)[2] * across_px - 1.0) < 1e-4);
  CHECK(std::abs((*sphere)[0] * across_px / cosine - 1.0) < 1e-4);
  CHECK(std::abs((*sphere)[1]) * across_px < 1e-6);
  // The disc is parallel to the image: a circle of R f / Z.
  CHECK(std::abs((*disc)[0] * radius_m * 500.0 - 1.0) < 1e-6);
  CHECK(std::abs((*disc)[2] * radius_m * 500.0 - 1.0) < 1e-6);
}

TEST_CASE("a sphere's place comes back from the centre of its own image to a millionth of what is put right") {
  const KnownCamera known{.fx = 500.0, .fy = 500.0};
  const KnownPlane plane = slanted();
  cv::RNG random(1);
  const auto corners = tests::known_corners(known, plane, 0.04, 0.0, random);
  const auto sphere = core::Restitution::from_pattern(exact(known), {corners}, 0.04, 0.02, 0.12);
  for (const cv::Point2d place : {cv::Point2d(0.7, 0.3), cv::Point2d(-0.4, 0.4), cv::Point2d(0.7, -0.3)}) {
    const cv::Point2d seen = sphere.to_pixel(place);
    const auto found = sphere.to_plane(seen), as_a_point = sphere.to_plane(sphere.centre_pixel(place));
    REQUIRE((found && as_a_point));
    const double put_right_m = cv::norm(*as_a_point - place);
    CHECK(put_right_m > 1e-4);  // so that a millionth is above the nanometre that rounding leaves in a plane
    CHECK(cv::norm(*found - place) < 1e-6 * put_right_m + 1e-9);
  }
}

TEST_CASE("several plane views join in one plane, with the first one's origin") {
  const KnownCamera known;
  const KnownPlane plane = slanted();
  cv::RNG random(4);
  const auto first = tests::known_corners(known, plane, 0.04, 0.0, random);
  const auto second = tests::known_corners(known, plane, 0.04, 0.0, random, {0.45, -0.03}, 0.12);
  const auto restitution = core::Restitution::from_pattern(exact(known), {first, second}, 0.04, 0.0, 0.0);
  REQUIRE(restitution.plane()->in_plane.size() == 2);
  const Eigen::Vector3d moved = restitution.plane()->in_plane[1];
  CHECK(std::abs(moved[0] - 0.12) < 1e-9);
  CHECK(std::abs(moved[1] - 0.45) < 1e-9);
  CHECK(std::abs(moved[2] + 0.03) < 1e-9);
  const auto found = restitution.to_plane(known.project(plane.at(0.7, 0.2)));
  CHECK(std::hypot(found->x - 0.7, found->y - 0.2) < 1e-9);
}

TEST_CASE("a calibrated camera restitutes the whole field within a few hundredths of a per cent, and says how well") {
  const KnownCamera known;
  const KnownPlane plane = slanted();
  double sum_z2 = 0.0;
  for (int seed = 1; seed <= 12; ++seed) {
    cv::RNG random(static_cast<std::uint64_t>(seed));
    core::BoardViews boards = tests::known_views(known, 0.01, random);
    const auto corners = tests::known_corners(known, plane, 0.04, 0.01, random);
    boards.views.push_back({"plane.png", corners});
    const auto calibration = core::calibrate_camera(boards, 0.04);
    const auto restitution = core::Restitution::from_pattern(calibration, {corners}, 0.04, 0.0, 0.0);
    const cv::Point2d left = known.project(plane.at(-0.4, 0.1));
    const cv::Point2d right = known.project(plane.at(0.8, 0.1));
    const double length = cv::norm(*restitution.to_plane(right) - *restitution.to_plane(left));
    const double error = length / 1.2 - 1.0;
    double variance = 0.0;
    for (const core::RestitutionMode& mode : restitution.modes()) {
      const double moved = cv::norm(*mode.to_plane(right) - *mode.to_plane(left));
      variance += std::pow((moved - length) / mode.sds / 1.2, 2);
    }
    const double sd = std::sqrt(variance);
    INFO("seed " << seed << ": relative error " << error << ", stated sd " << sd);
    CHECK(std::abs(error) < 5e-4);
    CHECK(sd < 5e-4);
    sum_z2 += std::pow(error / sd, 2);
    // sd 0.01 px at 1.9 mm a pixel, six pose parameters of 108 data.
    CHECK(std::abs(restitution.plane()->rms_m - 0.01 * 1.6 / 830.0) < 0.3 * 0.01 * 1.6 / 830.0);
  }
  // The sum of 12 squared standardised errors: chi-squared, 3.07 to 28.3 at 0.5 % on each side.
  CHECK(sum_z2 > 3.07);
  CHECK(sum_z2 < 28.3);
}

TEST_CASE("planes of one calibration have the camera's modes in common, and each its own of the pose") {
  const KnownCamera known;
  cv::RNG random(3);
  core::BoardViews boards = tests::known_views(known, 0.02, random);
  const auto one = tests::known_corners(known, slanted(), 0.04, 0.02, random);
  const auto two =
      tests::known_corners(known, tests::known_plane({0, 0, 1.4}, 0, 0.1, 0, 0.16, 0.1), 0.04, 0.02, random);
  auto calibration = core::calibrate_camera(boards, 0.04);
  const auto first = core::Restitution::from_pattern(calibration, {one}, 0.04, 0.0, 0.0).modes();
  const auto second = core::Restitution::from_pattern(calibration, {two}, 0.04, 0.0, 0.0).modes();
  REQUIRE(first.size() == second.size());
  std::size_t of_camera = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    CHECK(first[k].of_camera == second[k].of_camera);
    CHECK(first[k].camera.fx == second[k].camera.fx);
    CHECK(first[k].camera.distortion == second[k].camera.distortion);
    if (!first[k].of_camera) {
      CHECK(first[k].camera.fx == calibration.camera.fx);
      continue;
    }
    CHECK(k == of_camera++);
  }
  CHECK(first.size() == of_camera + 6);
  // The modes' squares add up to the covariance.
  double variance = 0.0;
  for (const auto& mode : first) variance += std::pow((mode.camera.fx - calibration.camera.fx) / mode.sds, 2);
  CHECK(std::abs(variance / calibration.covariance(0, 0) - 1.0) < 1e-6);  // differences of numbers of 830 at 1e-13

  calibration.covariance.setZero();  // a camera that is known: the plane's pose is left
  const auto known_camera = core::Restitution::from_pattern(calibration, {one}, 0.04, 0.0, 0.0).modes();
  REQUIRE(known_camera.size() == 6);
  for (const auto& mode : known_camera) CHECK_FALSE(mode.of_camera);
}

TEST_CASE("one scale divides pixels by it and hands its uncertainty on") {
  const auto restitution = core::Restitution::from_scale({480.0, 40.0}, 0.05);
  const auto found = restitution.to_plane({240.0, 120.0});
  CHECK(found->x == 0.5);
  CHECK(found->y == 0.25);
  CHECK(restitution.relative_scale_sd() == 40.0 / 480.0);
  CHECK(restitution.modes().empty());
  CHECK(*restitution.marker_radius_px({0, 0}) == 12.0);
}
