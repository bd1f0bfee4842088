#include "core/motion/smoothing/grid_block.h"

#include <Eigen/Dense>

#include <cmath>
#include <random>
#include <vector>

#include "core/motion/smoothing/local_polynomial.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::core;

namespace {

constexpr double kStep = 0.005;

std::vector<double> even_times(std::size_t count) {
  std::vector<double> t;
  for (std::size_t i = 0; i < count; ++i) t.push_back(3.0 + kStep * static_cast<double>(i));
  return t;
}

/// A distant origin, a path and noise of its own size: no digits are spared.
std::vector<double> positions(std::size_t count) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::vector<double> x;
  for (std::size_t i = 0; i < count; ++i) x.push_back(10.0 + std::sin(0.05 * static_cast<double>(i)) + noise(random));
  return x;
}

/// x, v, a by weighted least squares over all points, by QR.
Eigen::Vector3d by_qr(const std::vector<double>& t, const std::vector<double>& x, std::size_t j,
                      const PolynomialOptions& how) {
  const double h = how.bandwidth_s, reach = how.kernel == Kernel::gaussian ? how.reach : 1.0;
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(t.size()), 4);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(design.rows());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double s = (t[i] - t[j]) / h;
    if (std::abs(s) > reach * (1.0 + 1e-9)) continue;
    const double root = std::sqrt(kernel_value(how.kernel, s));
    const auto r = static_cast<Eigen::Index>(i);
    for (int power = 0; power < 4; ++power) design(r, power) = root * std::pow(s, power);
    right[r] = root * (x[i] - x[j]);
  }
  const Eigen::VectorXd c = design.colPivHouseholderQr().solve(right);
  return {c[0] + x[j], c[1] / h, 2.0 * c[2] / (h * h)};
}

double sum_of_magnitudes(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double w : weights) sum += std::abs(w);
  return sum;
}

/// The sums lose three digits of 16 (condition below 1200) and add up a hundred terms that are rounded at random
/// (another digit); x reaches 1.5 from the origin. 1e-11 of the weights' magnitudes leaves less than a digit.
void check_all_points(const std::vector<double>& t, const PolynomialOptions& how) {
  const std::vector<double> x = positions(t.size());
  const LocalPolynomial smoother(t, how);
  const auto smoothed = smoother.smooth(x);
  for (std::size_t j = 0; j < t.size(); ++j) {
    INFO("bandwidth " << how.bandwidth_s / kStep << " steps, " << t.size() << " points, point " << j);
    const auto row = smoother.row_of_point(j);
    REQUIRE(smoothed[j].has_value() == row.has_value());
    if (!row) continue;
    const Eigen::Vector3d expected = by_qr(t, x, j, how);
    CHECK(std::abs(smoothed[j]->x_m - expected[0]) < 1e-11 * sum_of_magnitudes(row->weights->x));
    CHECK(std::abs(smoothed[j]->v_m_s - expected[1]) < 1e-11 * sum_of_magnitudes(row->weights->v));
    CHECK(std::abs(smoothed[j]->a_m_s2 - expected[2]) < 1e-11 * sum_of_magnitudes(row->weights->a));
  }
}

PolynomialOptions cubic(double steps, Kernel kernel = Kernel::gaussian) {
  PolynomialOptions how;
  how.kernel = kernel;
  how.bandwidth_s = steps * kStep;
  return how;
}

}  // namespace

TEST_CASE("cubics at both ends of an even grid are weighted least squares solved by QR, at every bandwidth") {
  for (const double steps : {0.7, 1.0, 1.17, 2.0, 3.5, 5.0, 8.0, 12.0}) check_all_points(even_times(200), cubic(steps));
}

TEST_CASE("cubics whose windows are cut off at both ends are weighted least squares solved by QR") {
  for (const std::size_t count : {5, 7, 8, 9, 15, 16, 17, 40}) check_all_points(even_times(count), cubic(7.0));
}

TEST_CASE("cubics at the ends of a grid with other kernels are weighted least squares solved by QR") {
  for (const Kernel kernel : {Kernel::epanechnikov, Kernel::tricube, Kernel::uniform}) {
    for (const double steps : {6.0, 7.3, 12.0}) check_all_points(even_times(60), cubic(steps, kernel));
  }
}

TEST_CASE("ends of an even grid that lie near a gap keep the weights of their uneven windows") {
  std::vector<double> t = even_times(120);
  t.erase(t.begin() + 15, t.begin() + 17);
  t.erase(t.begin() + 90);
  check_all_points(t, cubic(3.0));
}

TEST_CASE("a window that hardly determines its cubic is left to orthogonal polynomials") {
  // Of one side of a Gaussian of 0.35 steps the fourth point has a weight of 1e-16.
  PolynomialOptions how = cubic(0.35);
  how.reach = 30.0;
  const std::vector<double> t = even_times(60), x = positions(60);
  const LocalPolynomial smoother(t, how);
  const auto smoothed = smoother.smooth(x);
  const auto row = smoother.row_of_point(0);
  REQUIRE(smoothed[0].has_value() == row.has_value());
  CHECK_FALSE(row);

  std::vector<double> kernel;
  for (int d = 0; d < 11; ++d) kernel.push_back(kernel_value(Kernel::gaussian, d / 0.35));
  const GridEnds ends(kernel, 1.0 / 0.35, 0.35);
  const std::vector<double> values(2 * ends.lags() + kGridLanes, 0.0);
  std::array<std::size_t, kGridLanes> before{0, 1, 2, 3, 4, 5, 6, 7}, after{};
  after.fill(10);
  const GridBlock block = ends.solve(values.data() + ends.lags(), before, after);
  CHECK_FALSE(block.determined[0]);
}

TEST_CASE("the lanes of a grid's block give the same bits with any vectors") {
  const std::vector<double> values = positions(60);
  std::vector<double> kernel;
  for (int d = 0; d <= 24; ++d) kernel.push_back(kernel_value(Kernel::gaussian, d / 4.0));
  const GridFilter filter{kernel, kernel, kernel};
  const GridEnds ends(kernel, 0.25, 0.02);
  const std::array<std::size_t, kGridLanes> before{24, 24, 24, 24, 24, 24, 24, 24},
      after{24, 23, 22, 21, 20, 19, 18, 17};
  const double* const middle = values.data() + 24;
  const GridBlock best = filter_block(filter, middle, base::Simd::best);
  const GridBlock plain = filter_block(filter, middle, base::Simd::baseline);
  CHECK((best.x == plain.x && best.v == plain.v && best.a == plain.a));
  const GridBlock best_end = ends.solve(middle, before, after, base::Simd::best);
  const GridBlock plain_end = ends.solve(middle, before, after, base::Simd::baseline);
  CHECK((best_end.x == plain_end.x && best_end.v == plain_end.v && best_end.a == plain_end.a));
  CHECK(best_end.determined == plain_end.determined);
}
