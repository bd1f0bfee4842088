#include "core/motion/smoothing/local_polynomial.h"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>
#include <random>

#include "base/errors.h"
#include "tests/catch.h"

using namespace glidelab::core;

namespace {

constexpr Kernel kKernels[] = {Kernel::gaussian, Kernel::epanechnikov, Kernel::tricube, Kernel::uniform,
                               Kernel::bimodal};

/// The reach of a compact kernel is one bandwidth, of a Gaussian six: these bandwidths smooth about the same.
double bandwidth_of(Kernel kernel) {
  return kernel == Kernel::gaussian || kernel == Kernel::bimodal ? 0.05 : 0.14;
}

PolynomialOptions options(int order, Kernel kernel, double bandwidth_s) {
  PolynomialOptions made;
  made.order = order;
  made.kernel = kernel;
  made.bandwidth_s = bandwidth_s;
  return made;
}

/// Steps between 0.4 and 1.6 of 10 ms, and a hole of 40 ms.
std::vector<double> irregular_times(std::size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> step(0.004, 0.016);
  std::vector<double> t{0.0};
  while (t.size() < count) t.push_back(t.back() + step(random) + (t.size() == count / 2 ? 0.04 : 0.0));
  return t;
}

/// 10 ms apart, with two frames missing.
std::vector<double> times_with_missing_frames() {
  std::vector<double> t;
  for (int i = 0; i < 150; ++i) {
    if (i != 70 && i != 76) t.push_back(0.01 * i);
  }
  return t;
}

double sum_of_magnitudes(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double w : weights) sum += std::abs(w);
  return sum;
}

/// The definition as it stands: weighted least squares by QR over all points; kernels written out anew.
Eigen::Vector3d by_qr(const std::vector<double>& t, const std::vector<double>& x, double at,
                      const PolynomialOptions& how) {
  std::vector<double> root(t.size(), 0.0);
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double s = std::abs(t[i] - at) / how.bandwidth_s;
    double k = 0.0;
    if (how.kernel == Kernel::gaussian && s < 6.0 + 1e-8)
      k = std::exp(-s * s / 2.0) / std::sqrt(2.0 * std::numbers::pi);
    if (how.kernel == Kernel::epanechnikov && s < 1.0) k = 0.75 * (1.0 - s * s);
    if (how.kernel == Kernel::tricube && s < 1.0) k = 70.0 / 81.0 * std::pow(1.0 - s * s * s, 3);
    if (how.kernel == Kernel::uniform && s < 1.0 + 1e-9) k = 0.5;
    if (how.kernel == Kernel::bimodal && s < 6.0 + 1e-8)
      k = 2.0 * s * s * std::exp(-s * s) / std::sqrt(std::numbers::pi);
    root[i] = std::sqrt(k * (how.weights.empty() ? 1.0 : how.weights[i]));
  }
  Eigen::MatrixXd design(t.size(), how.order + 1);
  Eigen::VectorXd right(t.size());
  for (Eigen::Index r = 0; r < design.rows(); ++r) {
    const auto i = static_cast<std::size_t>(r);
    for (int p = 0; p <= how.order; ++p) design(r, p) = root[i] * std::pow((t[i] - at) / how.bandwidth_s, p);
    right[r] = root[i] * x[i];
  }
  const Eigen::VectorXd b = design.colPivHouseholderQr().solve(right);
  const double h = how.bandwidth_s;
  return {b[0], b[1] / h, how.order >= 2 ? 2.0 * b[2] / (h * h) : 0.0};
}

/// Within `part` of what rounding of x = 1 would make through the weights.
void check_point(const SmoothedPoint& point, const Eigen::Vector3d& expected, const KernelWeights& weights,
                 double part) {
  CHECK(std::abs(point.x_m - expected[0]) < part * sum_of_magnitudes(weights.x));
  CHECK(std::abs(point.v_m_s - expected[1]) < part * sum_of_magnitudes(weights.v));
  if (!weights.a.empty()) CHECK(std::abs(point.a_m_s2 - expected[2]) < part * sum_of_magnitudes(weights.a));
}

}  // namespace

TEST_CASE("a polynomial of the order comes out as it is: any kernel, irregular times, a gap, both ends") {
  for (const Kernel kernel : kKernels) {
    for (int order = 1; order <= 5; ++order) {
      const auto t = irregular_times(120);
      const double middle = t[60];
      std::vector<double> x;
      for (const double time : t) {
        double sum = 0.0;
        for (int p = order; p >= 0; --p) sum = sum * (time - middle) + 0.3 + 0.2 * p;
        x.push_back(sum);
      }
      const LocalPolynomial smoother(t, options(order, kernel, bandwidth_of(kernel)));
      const auto smoothed = smoother.smooth(x);
      for (std::size_t j = 0; j < t.size(); ++j) {
        REQUIRE(smoothed[j]);
        Eigen::Vector3d expected = Eigen::Vector3d::Zero();
        for (int p = 0; p <= order; ++p) {
          const double c = 0.3 + 0.2 * p, u = t[j] - middle;
          expected[0] += c * std::pow(u, p);
          if (p >= 1) expected[1] += c * p * std::pow(u, p - 1);
          if (p >= 2) expected[2] += c * p * (p - 1) * std::pow(u, p - 2);
        }
        // |x| < 1: rounding is epsilon of the magnitudes summed, times the growth in the recurrence of order 5; 1e-12
        // leaves four digits for that.
        check_point(*smoothed[j], expected, *smoother.row_of_point(j)->weights, 1e-12);
      }
    }
  }
}

TEST_CASE("a local polynomial is weighted least squares solved by QR, weights of points included") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::uniform_real_distribution<double> of_point(0.2, 3.0);
  for (const std::vector<double>& t : {irregular_times(90), times_with_missing_frames()}) {
    std::vector<double> x, weights;
    for (const double time : t) {
      x.push_back(std::sin(3.0 * time) + noise(random));
      weights.push_back(of_point(random));
    }
    for (const Kernel kernel : kKernels) {
      for (int order = 1; order <= 5; ++order) {
        for (const bool weighted : {false, true}) {
          PolynomialOptions how = options(order, kernel, bandwidth_of(kernel));
          if (weighted) how.weights = weights;
          const LocalPolynomial smoother(t, how);
          for (const double at : {t.front(), t[3], 0.4 * t[40] + 0.6 * t[41], t[69] + 0.003, t.back()}) {
            const auto row = smoother.row(at);
            REQUIRE(row);
            // QR of the powers loses its condition, below 1e5 for order 5 at an end, times epsilon.
            check_point(weighted_sums(*row, x), by_qr(t, x, at, how), *row->weights, 1e-10);
          }
        }
      }
    }
  }
}

TEST_CASE("a local polynomial agrees with R's KernSmooth::locpoly") {
  // KernSmooth 2.23-20: n <- 121; i <- 0:(n-1); t <- 0.01*i; x <- sin(3*t) + 0.02*sin(37*i*i);
  // locpoly(t, x, drv, degree = degree, bandwidth = 0.061, gridsize = n, range.x = range(t))$y[c(1, 4, 31, 61, 115,
  // 121)] The points lie on its grid, so that it bins nothing; it cuts the Gaussian off at 4 bandwidths.
  struct Row {
    int drv, degree;
    double y[6];
  };
  const Row rows[] = {
      {0,
       1,
       {0.000869548960008301, 0.0901585981791393, 0.765387089854164, 0.959717343437465, -0.27433110054623,
        -0.456496531164793}},
      {1,
       1,
       {2.94264966315348, 2.89606690613364, 1.81404535149178, -0.615919732452444, -3.01670797042584,
        -3.03456182708223}},
      {2,
       2,
       {-4.57697593304247, -3.49138907391862, -6.82107280293315, -8.88525741057035, -1.12487398058506,
        0.311004167874019}},
      {0,
       3,
       {-0.00739378929558724, 0.0914728782568296, 0.778065106493898, 0.976231965778263, -0.273666244502588,
        -0.453189367913471}},
      {1,
       3,
       {3.5390028401465, 3.10857052175508, 1.84182152176145, -0.606483054370937, -3.05297951127045, -2.71106435592392}},
      {2,
       3,
       {-15.3173913304353, -7.63601313122827, -6.82107280293315, -8.88525741057035, -0.703512514606297,
        11.0166045903403}},
      {2,
       4,
       {-32.3096987203603, -17.4675835334557, -6.95406722712292, -8.82970699891664, 0.189624658032402,
        39.9283674920562}},
      {2,
       5,
       {32.6872466697283, -19.2339779956404, -6.95406722712292, -8.82970699891664, -4.83038086332654,
        26.7995845244868}}};
  std::vector<double> t, x;
  for (int i = 0; i < 121; ++i) {
    t.push_back(0.01 * i);
    x.push_back(std::sin(3.0 * 0.01 * i) + 0.02 * std::sin(37.0 * i * i));
  }
  for (const Row& row : rows) {
    PolynomialOptions how = options(row.degree, Kernel::gaussian, 0.061);
    how.reach = 4.0;
    const LocalPolynomial smoother(t, how);
    const auto smoothed = smoother.smooth(x);
    const std::size_t points[] = {0, 3, 30, 60, 114, 120};
    for (int p = 0; p < 6; ++p) {
      const SmoothedPoint& point = *smoothed[points[p]];
      const double value = row.drv == 0 ? point.x_m : row.drv == 1 ? point.v_m_s : point.a_m_s2;
      const std::shared_ptr<const KernelWeights> held = smoother.row_of_point(points[p])->weights;
      const KernelWeights& weights = *held;
      INFO("drv " << row.drv << " degree " << row.degree << " point " << points[p]);
      // locpoly solves normal equations: the square of QR's 1e5 times epsilon, and 15 printed digits.
      CHECK(std::abs(value - row.y[p]) < 1e-7 * sum_of_magnitudes(row.drv == 0   ? weights.x
                                                                  : row.drv == 1 ? weights.v
                                                                                 : weights.a));
    }
  }
}

TEST_CASE("uniform times with a frame missing are filtered where the window is full, and fitted elsewhere") {
  const auto t = times_with_missing_frames();
  for (const Kernel kernel : kKernels) {
    const LocalPolynomial smoother(t, options(3, kernel, bandwidth_of(kernel) == 0.05 ? 0.015 : 0.09));
    CHECK(smoother.row_of_point(20)->weights == smoother.row_of_point(30)->weights);
    CHECK(smoother.row_of_point(20)->weights != smoother.row_of_point(70)->weights);
    CHECK(smoother.row_of_point(20)->weights != smoother.row_of_point(2)->weights);
  }
}

TEST_CASE("a local line has no acceleration, and says so") {
  const auto t = irregular_times(40);
  const LocalPolynomial smoother(t, options(1, Kernel::tricube, 0.1));
  CHECK(std::isnan(smoother.smooth(t)[20]->a_m_s2));
  CHECK(smoother.row_of_point(20)->weights->a.empty());
  CHECK(smoother.smooth(t)[20]->v_m_s == Approx(1.0).epsilon(1e-12));  // rounding
}

TEST_CASE("too few points give nothing for every order and kernel") {
  std::vector<double> t;
  for (int i = 0; i < 30; ++i) t.push_back(0.01 * i);
  for (int order = 1; order <= 5; ++order) {
    // Within 1.001 · m · 10 ms lie 2 m + 1 points inside, m + 1 at an end.
    const int m = (order + 2) / 2;
    const bool enough_inside = 2 * m + 1 >= order + 2, enough_at_end = m + 1 >= order + 2;
    const LocalPolynomial smoother(t, options(order, Kernel::epanechnikov, 0.01001 * m));
    CHECK(smoother.row_of_point(15).has_value() == enough_inside);
    CHECK(smoother.row_of_point(0).has_value() == enough_at_end);
    CHECK_FALSE(smoother.row(0.5));
  }
}

TEST_CASE("covariances of x, v and a, at one point and between points, are W Sigma W'") {
  const auto t = irregular_times(60);
  const auto n = static_cast<Eigen::Index>(t.size());
  SeriesNoise noise{{2.0, 1.1, -0.4}, {}};
  for (std::size_t i = 0; i < t.size(); ++i) noise.factor.push_back(0.5 + 0.02 * static_cast<double>(i));
  Eigen::MatrixXd sigma = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index r = 0; r < n; ++r) {
    for (Eigen::Index c = 0; c < n; ++c) {
      const auto lag = static_cast<std::size_t>(std::abs(r - c));
      if (lag > 2) continue;
      sigma(r, c) = noise.autocovariance[lag] * noise.factor[static_cast<std::size_t>(r)] *
                    noise.factor[static_cast<std::size_t>(c)];
    }
  }
  const LocalPolynomial smoother(t, options(4, Kernel::tricube, 0.12));
  const auto dense = [&](const KernelRow& row) {
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero(3, n);
    for (std::size_t i = 0; i < row.weights->x.size(); ++i) {
      w.col(static_cast<Eigen::Index>(row.first + i)) << row.weights->x[i], row.weights->v[i], row.weights->a[i];
    }
    return w;
  };
  for (const auto& [i, j] : {std::pair{0, 0}, std::pair{30, 30}, std::pair{30, 34}, std::pair{5, 50}}) {
    const auto a = *smoother.row_of_point(static_cast<std::size_t>(i));
    const auto b = *smoother.row_of_point(static_cast<std::size_t>(j));
    const Eigen::Matrix3d expected = dense(a) * sigma * dense(b).transpose();
    const Eigen::Matrix3d found = point_covariance(a, b, noise);
    // Rounding: epsilon times the sum of magnitudes, which cancels by some 1e3 at most.
    const Eigen::Vector3d scale_a = (dense(a) * sigma * dense(a).transpose()).diagonal().cwiseSqrt();
    const Eigen::Vector3d scale_b = (dense(b) * sigma * dense(b).transpose()).diagonal().cwiseSqrt();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) CHECK(std::abs(found(r, c) - expected(r, c)) < 1e-11 * scale_a[r] * scale_b[c]);
    }
  }
  // A white noise without factors is noise_variance().
  const auto row = *smoother.row_of_point(20);
  CHECK(point_covariance(row, row, {{3.0}, {}})(2, 2) ==
        Approx(noise_variance(row.weights->a, std::vector<double>{3.0})).epsilon(1e-12));
}

TEST_CASE("what the stop check throws ends the smoothing of even and uneven times") {
  std::vector<double> even(20000);
  for (std::size_t i = 0; i < even.size(); ++i) even[i] = 0.01 * double(i);
  // Uneven times: a check for each point; even ones: for every 4096 of the filter, and for every eight of the ends.
  for (const auto& [t, least] : {std::pair{irregular_times(400), std::size_t{400}}, std::pair{even, std::size_t{6}}}) {
    const LocalPolynomial smoother(t, options(3, Kernel::gaussian, 0.05));
    const auto whole = smoother.smooth(t);
    std::size_t checks = 0;
    const auto checked = smoother.smooth(t, [&] { ++checks; });
    CHECK(checks >= least);
    for (std::size_t i = 0; i < t.size(); ++i) {
      REQUIRE(whole[i].has_value() == checked[i].has_value());
      if (whole[i] && whole[i]->x_m != checked[i]->x_m) FAIL("the check changes the values");
    }
    std::size_t left = checks;
    CHECK_THROWS_AS(smoother.smooth(t,
                                    [&] {
                                      if (--left == 0) throw glidelab::base::Interrupted();
                                    }),
                    glidelab::base::Interrupted);
    CHECK(left == 0);
  }
}
