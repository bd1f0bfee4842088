#include "core/pictures/board/corner_errors.h"

#include <Eigen/Dense>

#include <cmath>

#include "core/pictures/camera/calibrate.h"
#include "tests/catch.h"
#include "tests/core/known_camera.h"

using namespace glidelab;

namespace {

const cv::Size kGrid(9, 6);

/// Adds to each view's corners a smooth field of this size: Gaussian, correlated as exp(-d^2 / (2 length^2)).
void add_smooth(core::BoardViews& boards, double size_px, double length, cv::RNG& random) {
  const int n = kGrid.area();
  Eigen::MatrixXd k(n, n);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      const double dx = a % kGrid.width - b % kGrid.width, dy = a / kGrid.width - b / kGrid.width;
      k(a, b) = std::exp(-0.5 * (dx * dx + dy * dy) / (length * length)) + (a == b ? 1e-9 : 0.0);
    }
  }
  const Eigen::MatrixXd root = k.llt().matrixL();
  for (core::BoardView& view : boards.views) {
    Eigen::MatrixXd draw(n, 2);
    for (Eigen::Index i = 0; i < draw.size(); ++i) draw(i) = random.gaussian(size_px);
    const Eigen::MatrixXd field = root * draw;
    for (int a = 0; a < n; ++a)
      view.corners.points[static_cast<std::size_t>(a)] += cv::Point2d(field(a, 0), field(a, 1));
  }
}

}  // namespace

TEST_CASE("the covariance of the corners is its dense matrix times what it is given") {
  const core::CornerNoise noise{0.3, 0.7};
  const int n = kGrid.area();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      const double dx = a % kGrid.width - b % kGrid.width, dy = a / kGrid.width - b / kGrid.width;
      for (int c = 0; c < 2; ++c) {
        dense(2 * a + c, 2 * b + c) = 0.49 * std::exp(-(dx * dx + dy * dy) / 8.0) + (a == b ? 0.09 : 0.0);
      }
    }
  }
  const Eigen::MatrixXd some = Eigen::MatrixXd::Random(2 * n, 3);
  CHECK((core::times_covariance(noise, kGrid, some) - dense * some).norm() < 1e-12 * some.norm());
}

TEST_CASE("independent errors of corners are told from those that neighbours share") {
  const tests::KnownCamera known;
  for (const double smooth_px : {0.0, 0.01, 0.03}) {
    cv::RNG random(21);
    double white2 = 0.0, correlated2 = 0.0;
    constexpr int kTrials = 6;
    for (int k = 0; k < kTrials; ++k) {
      core::BoardViews boards = tests::known_views(known, 0.01, random);
      if (smooth_px > 0.0) add_smooth(boards, smooth_px, 2.0, random);
      const core::CornerNoise noise = core::calibrate_camera(boards, 0.04).noise;
      white2 += noise.white_px * noise.white_px / kTrials;
      correlated2 += noise.correlated_px * noise.correlated_px / kTrials;
    }
    INFO("smooth " << smooth_px << ": white " << std::sqrt(white2) << ", correlated " << std::sqrt(correlated2));
    // 12 views of some 5 independent patches, of which the pose takes half: 20 % of either over six trials.
    CHECK(std::abs(std::sqrt(white2) - 0.01) < 0.002);
    if (smooth_px > 0.0) CHECK(std::abs(std::sqrt(correlated2) / smooth_px - 1.0) < 0.35);
    if (smooth_px == 0.0) CHECK(std::sqrt(correlated2) < 0.003);
  }
}

TEST_CASE(
    "a camera's stated uncertainty holds where neighbouring corners err together, and independent noise's does not") {
  const tests::KnownCamera known;
  cv::RNG random(5);
  double z2 = 0.0, naive_z2 = 0.0;
  constexpr int kTrials = 30;
  for (int k = 0; k < kTrials; ++k) {
    core::BoardViews boards = tests::known_views(known, 0.005, random);
    add_smooth(boards, 0.02, 2.0, random);
    const core::Calibration calibration = core::calibrate_camera(boards, 0.04);
    const double error = calibration.camera.fx - known.fx;
    z2 += error * error / calibration.covariance(0, 0) / kTrials;
    // What independent errors of the same residuals would give, by OpenCV's formula: (J'J)^-1 rms^2, here from a
    // calibration of purely independent errors of that size.
    cv::RNG again(static_cast<std::uint64_t>(k + 1));
    const double rms = calibration.rms_px / std::sqrt(2.0);
    const core::Calibration white = core::calibrate_camera(tests::known_views(known, rms, again), 0.04);
    naive_z2 += error * error / white.covariance(0, 0) / kTrials;
  }
  INFO("mean square of error / sd: " << z2 << ", with independent errors " << naive_z2);
  // Chi-squared of 30 over 30: 0.46 to 1.79 at 0.5 % on each side; the camera's own terms take up a part of smooth
  // errors this large, of which the residuals know nothing, so that a variance half as large as it should be is
  // allowed.
  CHECK(z2 > 0.46);
  CHECK(z2 < 2.0 * 1.79);
  CHECK(naive_z2 > 4.0 * z2);
}
