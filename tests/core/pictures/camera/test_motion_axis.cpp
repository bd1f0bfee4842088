#include "core/pictures/camera/motion_axis.h"

#include <cmath>

#include "base/errors.h"
#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("exact points give their line, x from the origin's projection and positive downhill") {
  std::vector<cv::Point2d> points;
  const double angle = 0.07;
  const cv::Point2d along(std::cos(angle), std::sin(angle)), across(-std::sin(angle), std::cos(angle));
  for (int k = 0; k < 50; ++k) points.push_back(0.02 * k * along + 0.3 * across);
  const auto right = core::MotionAxis::through(points, core::Downhill::plus_x);
  const auto left = core::MotionAxis::through(points, core::Downhill::minus_x);
  CHECK(std::abs(right.angle_to_x_rad() - angle) < 1e-12);
  for (int k = 0; k < 50; ++k) {
    CHECK(std::abs(right.x_of(points[static_cast<std::size_t>(k)]) - 0.02 * k) < 1e-12);
    CHECK(std::abs(left.x_of(points[static_cast<std::size_t>(k)]) + 0.02 * k) < 1e-12);
  }
  CHECK(right.line().rms_across < 1e-12);
}

TEST_CASE("a line along Y is directed as +Y and -Y say, and its plane's origin is where x is 0") {
  std::vector<cv::Point2d> points;
  for (int i = 0; i < 20; ++i) points.emplace_back(0.2, 0.05 * i);
  const auto down = core::MotionAxis::through(points, core::Downhill::plus_y);
  const auto up = core::MotionAxis::through(points, core::Downhill::minus_y);
  for (const cv::Point2d& point : points) {
    CHECK(std::abs(down.x_of(point) - point.y) < 1e-12);
    CHECK(std::abs(up.x_of(point) + point.y) < 1e-12);
  }
  CHECK(core::MotionAxis::along(core::Downhill::minus_y).x_of({3.0, 2.0}) == -2.0);
  CHECK(core::MotionAxis::along(core::Downhill::minus_x).x_of({3.0, 2.0}) == -3.0);
}

TEST_CASE("a line's direction scatters as it says, in any direction") {
  cv::RNG random(5);
  double sum_z2 = 0.0, sum_sd = 0.0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double angle = -1.5 + 3.0 * trial / kTrials;
    const cv::Point2d along(std::cos(angle), std::sin(angle)), across(-std::sin(angle), std::cos(angle));
    std::vector<cv::Point2d> points;
    for (int k = 0; k < 100; ++k) points.push_back(0.01 * k * along + random.gaussian(1e-3) * across);
    const auto line = core::fit_plane_line(points, 1e-9);
    const double error = std::asin(along.cross(line.direction) * (line.direction.dot(along) < 0.0 ? -1.0 : 1.0));
    // 1 mm over lever arms of 0.29 m rms and 100 points: 3.5e-4 rad.
    // Neighbours that are off together by chance widen it in one trial of twenty, by up to a factor of two.
    CHECK(line.sd_angle_rad > 3.46e-4 - 0.8e-4);
    CHECK(line.sd_angle_rad < 2.0 * 3.46e-4);
    sum_sd += line.sd_angle_rad;
    sum_z2 += std::pow(error / line.sd_angle_rad, 2);
  }
  CHECK(std::abs(sum_sd / kTrials - 3.46e-4) < 0.4e-4);
  // Chi-squared of 60: 35.5 to 92 at 99.5 % each side; the biweight makes it up to 2 % wider.
  CHECK(sum_z2 > 35.0);
  CHECK(sum_z2 < 94.0);
}

TEST_CASE("a line's direction scatters as it says where neighbouring points are off together") {
  cv::RNG random(6);
  double sum_z2 = 0.0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<cv::Point2d> points;
    double off = 0.0;
    for (int k = 0; k < 400; ++k) {
      off =
          0.9 * off + random.gaussian(1e-3);  // correlated over ten points: the variance of a sum is 19 times as large
      points.emplace_back(0.0025 * k, off);
    }
    const auto line = core::fit_plane_line(points, 1e-9);
    sum_z2 += std::pow(std::atan(line.direction.y / line.direction.x) / line.sd_angle_rad, 2);
  }
  // Ten blocks leave 8 degrees of freedom: the mean square of Student's t is 8 / 6; blocks of 40 points lose a quarter
  // of the correlation (1 / (0.1 * 40)) and the robust weights some of the rest. Independent points would make it 19.
  CHECK(sum_z2 / kTrials < 4.0);
  CHECK(sum_z2 / kTrials > 0.7);
}

TEST_CASE("a fifth of the points off the line does not turn it") {
  std::vector<cv::Point2d> points;
  cv::RNG random(3);
  for (int k = 0; k < 200; ++k) points.emplace_back(0.005 * k, 0.1 + random.gaussian(1e-4));
  for (int k = 0; k < 50; ++k) points.emplace_back(1.0 + 0.0001 * k, 0.25);  // a marker that fell off its track
  const auto axis = core::MotionAxis::through(points, core::Downhill::plus_x);
  CHECK(std::abs(axis.angle_to_x_rad()) < 1e-4);
  CHECK(axis.line().used >= 150);
  CHECK(axis.line().used <= 200);
}

TEST_CASE("points in one place make no line") {
  CHECK_THROWS_AS(core::fit_plane_line({{1.0, 2.0}, {1.0, 2.0}}, 1e-9), base::NumericalError);
  CHECK_THROWS_AS(core::fit_plane_line({}, 1e-9), base::NumericalError);
}
