#include "core/pictures/marker/marker_body.h"

#include <cmath>

#include "core/pictures/camera/restitution.h"
#include "tests/catch.h"
#include "tests/core/known_camera.h"

using namespace glidelab;

namespace {

constexpr double kRadius_m = 0.01, kFrameRate_hz = 60.0;

core::Restitution facing(double tilt_rad = 0.0) {
  const tests::KnownCamera known{.fx = 800.0, .fy = 800.0, .k1 = 0.0, .k2 = 0.0, .p1 = 0.0, .p2 = 0.0};
  const tests::KnownPlane plane = tests::known_plane({0.0, 0.0, 1.2}, 0.0, tilt_rad, 0.0, 0.16, 0.10);
  cv::RNG random(1);
  core::Calibration calibration;
  calibration.camera = {known.fx, known.fy, known.cx, known.cy, {}, known.size};
  return core::Restitution::from_pattern(calibration, {tests::known_corners(known, plane, 0.04, 0.0, random)}, 0.04,
                                         0.0, 2.0 * kRadius_m);
}

/// M^-2, whose eigenvalues are the squares of the half axes, longer along the motion.
cv::Vec3d smeared(const cv::Vec3d& shape, cv::Point2d motion_px, double share) {
  const double det = shape[0] * shape[2] - shape[1] * shape[1];
  const double a = shape[2] / det, b = -shape[1] / det, c = shape[0] / det;
  const cv::Matx22d square = cv::Matx22d(a, b, b, c) * cv::Matx22d(a, b, b, c) +
                             share * cv::Matx22d(motion_px.x * motion_px.x, motion_px.x * motion_px.y,
                                                 motion_px.x * motion_px.y, motion_px.y * motion_px.y);
  const double s = std::sqrt(cv::determinant(square)), t = std::sqrt(cv::trace(square) + 2.0 * s);
  const cv::Matx22d m = (1.0 / t * (square + s * cv::Matx22d::eye())).inv();
  return {m(0, 0), m(0, 1), m(1, 1)};
}

/// A glider that slows down from 0.5 m left of the middle to `to` m right of it; axes that err by 0.4 %.
std::vector<core::OutlineSeen> outlines(const core::Restitution& restitution, core::MarkerBody body, double from,
                                        double to, double smear, double cut) {
  cv::RNG random(5);
  std::vector<core::OutlineSeen> seen;
  constexpr int kFrames = 60;
  for (int k = 0; k < kFrames; ++k) {
    const auto x_of = [&](double t) { return from + (to - from) * (1.6 * t - 0.6 * t * t) + 0.16; };
    const double t = static_cast<double>(k) / kFrames;
    const cv::Point2d place(x_of(t), 0.13), pixel = restitution.to_pixel(place);
    core::OutlineSeen one;
    one.sphere = *restitution.marker_shape(pixel);
    one.disc = *restitution.disc_shape(pixel);
    one.motion_px = pixel - restitution.to_pixel({x_of(t - 1.0 / kFrames), 0.13});
    one.seen = smeared(body == core::MarkerBody::disc ? one.disc : one.sphere, one.motion_px, smear);
    one.seen[0] *= 1.0 + cut + random.gaussian(0.004);
    one.seen[2] *= 1.0 - cut + random.gaussian(0.004);
    seen.push_back(one);
  }
  return seen;
}

}  // namespace

TEST_CASE("Outlines tell a sphere from a disc, smeared by motion and cut not quite round") {
  for (const double tilt : {0.0, 0.3}) {
    const core::Restitution restitution = facing(tilt);
    for (const core::MarkerBody body : {core::MarkerBody::sphere, core::MarkerBody::disc}) {
      for (const double smear : {0.0, 0.02, 0.08}) {
        for (const double cut : {0.0, 0.02}) {
          CAPTURE(tilt, body == core::MarkerBody::disc, smear, cut);
          CHECK(core::body_by_outline(outlines(restitution, body, -0.5, 0.3, smear, cut)) == body);
        }
      }
    }
  }
}

TEST_CASE("Outlines near the axis, or of a few frames, leave the body open") {
  const core::Restitution restitution = facing();
  CHECK_FALSE(core::body_by_outline(outlines(restitution, core::MarkerBody::disc, -0.1, 0.1, 0.0, 0.0)));
  auto few = outlines(restitution, core::MarkerBody::disc, -0.5, 0.3, 0.0, 0.0);
  few.resize(12);
  CHECK_FALSE(core::body_by_outline(few));
}

TEST_CASE("Where both bodies have the same outline, no number of frames makes one of them") {
  cv::RNG random(2);
  std::vector<core::OutlineSeen> same(40000);
  for (core::OutlineSeen& outline : same) {
    const cv::Vec3d circle(0.1, 0.0, 0.1), noise(random.gaussian(1e-5), random.gaussian(1e-5), random.gaussian(1e-5));
    outline = {circle + noise, circle, circle, {1.0, 0.0}};
  }
  CHECK_FALSE(core::body_by_outline(same));
}

TEST_CASE("The centre of a disc in a tilted plane is found from its image's centroid") {
  core::Restitution restitution = facing(0.5);
  restitution.take_for_disc();
  // The oracle: the mean of the projections of points that fill the disc, each by the area that its surroundings have
  // in the image.
  const tests::KnownCamera known{.fx = 800.0, .fy = 800.0, .k1 = 0.0, .k2 = 0.0, .p1 = 0.0, .p2 = 0.0};
  const tests::KnownPlane plane = tests::known_plane({0.0, 0.0, 1.2}, 0.0, 0.5, 0.0, 0.16, 0.10);
  for (const cv::Point2d place : {cv::Point2d(-0.3, 0.13), cv::Point2d(0.5, 0.0)}) {
    cv::Point2d sum;
    double area = 0.0;
    constexpr int kSteps = 200;
    for (int j = -kSteps; j <= kSteps; ++j) {
      for (int i = -kSteps; i <= kSteps; ++i) {
        if (i * i + j * j > kSteps * kSteps) continue;
        const cv::Vec3d at = plane.at(place.x + kRadius_m * i / kSteps, place.y + kRadius_m * j / kSteps);
        const double weight = 1.0 / (at[2] * at[2] * at[2]);  // the Jacobian of a projection of a plane, but a constant
        sum += weight * known.project(at);
        area += weight;
      }
    }
    const cv::Point2d found = *restitution.to_plane(sum / area);
    CAPTURE(place);
    CHECK(cv::norm(found - place) < 2e-7);  // the 48 points of the outline miss 0.3 % of some 30 um
    CHECK(cv::norm(restitution.to_pixel(place) - sum / area) < 2e-4);
  }
}
