#include "core/pictures/board/corner_errors.h"

#include <Eigen/Dense>

#include <cmath>
#include <random>

#include "core/pictures/camera/calibrate.h"
#include "tests/catch.h"
#include "tests/core/known_camera.h"

using namespace glidelab;

namespace {

constexpr double kSd_px = 0.05;

/// Boards of 9 x 6 corners at twenty places of an image of 800 x 600, each corner off by `off` and noise.
template <class Off>
std::vector<core::CornerRest> rests_of(Off off, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, kSd_px);
  std::uniform_real_distribution<double> left(0.0, 430.0), top(0.0, 380.0);
  std::vector<core::CornerRest> rests;
  for (int view = 0; view < 20; ++view) {
    const cv::Point2d at(left(random), top(random));
    std::vector<cv::Point2d> corners;
    Eigen::VectorXd residual(2 * 54);
    for (int k = 0; k < 54; ++k) {
      corners.emplace_back(at + cv::Point2d(40.0 * (k % 9), 40.0 * (k / 9)));
      const cv::Point2d real = off(corners.back());
      residual[2 * k] = real.x + noise(random);
      residual[2 * k + 1] = real.y + noise(random);
    }
    core::add_rests(corners, residual, rests);
  }
  return rests;
}

}  // namespace

TEST_CASE("independent errors leave means as large as their number allows", "[corner map]") {
  double sum = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const core::CornerMap map = core::corner_map({800, 600}, rests_of([](cv::Point2d) { return cv::Point2d(); }, seed));
    CHECK(map.cells.size() <= 48);
    // 2 x (1080 - 48) numbers: known to 1 / sqrt(2 x 2064) = 1.6 %.
    CHECK(std::abs(map.scatter_px / kSd_px - 1.0) < 0.08);
    for (const core::CornerCell& cell : map.cells) {
      CHECK(cell.sd_px == Approx(map.scatter_px / std::sqrt(static_cast<double>(cell.corners))));
    }
    sum += map.excess * map.excess / 20.0;
  }
  // The mean over 20 x 96 squares of normal deviates is known to sqrt(2 / 1920) = 3.2 %.
  CHECK(std::abs(sum - 1.0) < 0.15);
}

TEST_CASE("what all views leave at one place stands in its cell, and raises the excess", "[corner map]") {
  const auto bent = [](cv::Point2d at) { return cv::Point2d(1e-6 * std::pow(at.x - 400.0, 2), 0.0); };
  const core::CornerMap map = core::corner_map({800, 600}, rests_of(bent, 3));
  std::size_t corners = 0;
  double means = 0.0;
  for (const core::CornerCell& cell : map.cells) {
    corners += cell.corners;
    // Over a cell of 100 px the bend differs from that at the middle by (100 px)² / 12 at most in the mean, 1e-3 px.
    CHECK(std::abs(cell.du_px - bent({cell.u_px, 0.0}).x) < 5.0 * cell.sd_px + 1e-3);
    CHECK(std::abs(cell.dv_px) < 5.0 * cell.sd_px);
    means += (std::pow(bent({cell.u_px, 0.0}).x / cell.sd_px, 2) + 2.0) / (2.0 * static_cast<double>(map.cells.size()));
  }
  CHECK(corners > 1000);
  CHECK(map.excess > 2.0);
  CHECK(map.excess == Approx(std::sqrt(means)).epsilon(0.15));
}

TEST_CASE("without corners, or with one in each cell, nothing is said", "[corner map]") {
  CHECK(core::corner_map({800, 600}, {}).cells.empty());
  const core::CornerMap map = core::corner_map({800, 600}, {{{50.0, 50.0}, {0.1, 0.1}}, {{750.0, 550.0}, {0.1, 0.1}}});
  CHECK(map.cells.empty());
  CHECK(map.excess == 0.0);
}

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
