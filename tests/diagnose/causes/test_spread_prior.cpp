#include "diagnose/causes/spread_prior.h"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// Log of the mean over widths of the integral of the likelihood, exp(-(s - a)' C⁻¹ (s - a)/2), over sizes a of this
/// width, less the same over a flat prior of density 1, by quadrature.
double by_quadrature(const Eigen::Vector2d& sizes, const Eigen::Matrix2d& covariance, double least) {
  const Eigen::Matrix2d information = covariance.inverse();
  // The axes of the narrow peak, twelve standard deviations to either side.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  constexpr int kCells = 600;
  double mean = 0.0;
  for (int w = 0; w < 13; ++w) {
    const double width = 2.0 * least * std::pow(10.0, w / 3.0);
    double sum = 0.0;
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        const Eigen::Vector2d u{24.0 * ((i + 0.5) / kCells - 0.5), 24.0 * ((j + 0.5) / kCells - 0.5)};
        const Eigen::Vector2d a = sizes + eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().cwiseProduct(u);
        const double off = (a - sizes).dot(information * (a - sizes));
        sum += std::exp(-0.5 * off - 0.5 * a.squaredNorm() / (width * width)) / (width * width);
      }
    }
    const double cell = 24.0 * 24.0 / kCells / kCells * std::sqrt(covariance.determinant());
    mean += sum * cell / (2.0 * std::numbers::pi) / 13.0;
  }
  // Over a flat prior the integral is 2 pi sqrt(det C).
  return std::log(mean) - 0.5 * std::log(covariance.determinant());
}

}  // namespace

TEST_CASE(
    "the cost of sizes of one kind is that of averaging over them and over their width, however they are correlated") {
  for (const double correlation : {0.0, 0.9, 0.999}) {
    CAPTURE(correlation);
    const double a = 0.3, b = 0.5;
    Eigen::Matrix2d covariance;
    covariance << a * a, correlation * a * b, correlation * a * b, b * b;
    const Eigen::Vector2d sizes{0.7, 1.1};
    const double least = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[0]);
    // The density is relative to a flat prior of density 1 and to a factor of sqrt(2 pi) for each size.
    CHECK(std::abs(diagnose::log_spread_prior(sizes, covariance, {0, 0}) - by_quadrature(sizes, covariance, least)) <
          0.01);
  }
}

TEST_CASE("a friction and a drag of each clip that are only known together cost as much as what is known of them") {
  // For the two sizes of each clip, the data determine the sum to 1e-3 and say next to nothing of the difference. That
  // is one size for each clip. Its cost is that of the sums alone, whose width is sqrt(2) times as large.
  const Eigen::Index clips = 8;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(2 * clips, 2 * clips);
  Eigen::VectorXd sizes(2 * clips), sums(clips);
  const double known = 1e-3, open = 1e4;
  for (Eigen::Index c = 0; c < clips; ++c) {
    const double both = 0.5 * (known * known + open * open) / 2.0, across = 0.5 * (known * known - open * open) / 2.0;
    covariance(2 * c, 2 * c) = covariance(2 * c + 1, 2 * c + 1) = both;
    covariance(2 * c, 2 * c + 1) = covariance(2 * c + 1, 2 * c) = across;
    sums[c] = c % 2 == 0 ? 0.05 : -0.03;
    sizes[2 * c] = sizes[2 * c + 1] = 0.5 * sums[c];
  }
  const double pairs = diagnose::log_spread_prior(sizes, covariance, std::vector<std::size_t>(2 * clips, 0));
  // In orthonormal combinations: (a + b)/sqrt(2) with known/sqrt(2), and the difference, which is as open as its prior.
  const Eigen::MatrixXd of_sums = Eigen::MatrixXd::Identity(clips, clips) * known * known / 2.0;
  const double alone = diagnose::log_spread_prior(sums / std::sqrt(2.0), of_sums, std::vector<std::size_t>(clips, 0));
  // An open difference has the width of its prior: N(0, open²/2) at 0, for each.
  const double of_open = -static_cast<double>(clips) * 0.5 * std::log(open * open / 2.0);
  CHECK(std::abs(pairs - (alone + of_open)) < 0.2);
}
