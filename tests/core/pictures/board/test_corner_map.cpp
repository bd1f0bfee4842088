#include "core/pictures/board/corner_errors.h"

#include <cmath>
#include <random>

#include "tests/catch.h"

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
