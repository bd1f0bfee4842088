#include "core/motion/smoothing/local_polynomial.h"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/catch.h"

using namespace glidelab::core;

namespace {

std::vector<double> uniform_times(std::size_t count, double step, double from = 0.0) {
  std::vector<double> t(count);
  for (std::size_t i = 0; i < count; ++i) t[i] = from + static_cast<double>(i) * step;
  return t;
}

/// Steps between 0.4 and 1.6 of 10 ms, and a hole of 80 ms.
std::vector<double> irregular_times(std::size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> step(0.004, 0.016);
  std::vector<double> t{0.0};
  while (t.size() < count) t.push_back(t.back() + step(random) + (t.size() == count / 2 ? 0.08 : 0.0));
  return t;
}

template <typename F>
std::vector<double> sampled(const std::vector<double>& t, F f) {
  std::vector<double> x;
  for (const double time : t) x.push_back(f(time));
  return x;
}

/// Equation (10) as it stands: weighted least squares by QR, over the points within the kernel's reach.
Eigen::Vector4d by_qr(const std::vector<double>& t, const std::vector<double>& x, double at, double h) {
  std::vector<std::size_t> within;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (std::abs(t[i] - at) <= kKernelReach * h) within.push_back(i);
  }
  Eigen::MatrixXd design(within.size(), 4);
  Eigen::VectorXd right(within.size());
  for (std::size_t r = 0; r < within.size(); ++r) {
    const double u = t[within[r]] - at, root = std::exp(-u * u / (4.0 * h * h));
    for (int power = 0; power < 4; ++power) design(static_cast<Eigen::Index>(r), power) = root * std::pow(u / h, power);
    right[static_cast<Eigen::Index>(r)] = root * x[within[r]];
  }
  Eigen::Vector4d solution = design.colPivHouseholderQr().solve(right);
  for (int power = 0; power < 4; ++power) solution[power] /= std::pow(h, power);
  return solution;
}

double sum_of_magnitudes(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double w : weights) sum += std::abs(w);
  return sum;
}

}  // namespace

TEST_CASE("a cubic comes out of the local cubic as it is, at any times, over a gap and at both ends") {
  for (const std::vector<double>& t : {irregular_times(300), uniform_times(300, 0.01, 5.0)}) {
    const double middle = t[150];
    const auto x = sampled(t, [&](double time) {
      const double u = time - middle;
      return 0.3 - 0.8 * u + 0.5 * u * u + 0.2 * u * u * u;
    });
    const LocalCubic cubic(t, 0.04);
    const auto smoothed = cubic.smooth(x);
    for (std::size_t j = 0; j < t.size(); ++j) {
      REQUIRE(smoothed[j]);
      const double u = t[j] - middle;
      const auto weights = cubic.row_of_point(j)->weights;
      // Rounding of weights and sums: each weight is good to the condition of the moments (some 1e3 at an end) times
      // epsilon; 1e-12 of the sum of the magnitudes leaves a factor of some ten.
      CHECK(std::abs(smoothed[j]->x_m - x[j]) < 1e-12 * sum_of_magnitudes(weights->x));
      CHECK(std::abs(smoothed[j]->v_m_s - (-0.8 + u + 0.6 * u * u)) < 1e-12 * sum_of_magnitudes(weights->v));
      CHECK(std::abs(smoothed[j]->a_m_s2 - (1.0 + 1.2 * u)) < 1e-12 * sum_of_magnitudes(weights->a));
    }
  }
}

TEST_CASE("the local cubic is equation (10) solved by QR, at points and between them") {
  const auto t = irregular_times(200);
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 0.01);
  const auto x = sampled(t, [&](double time) { return std::sin(3.0 * time) + noise(random); });
  const double h = 0.05;
  const LocalCubic cubic(t, h);
  for (const double at : {t.front(), t[3], 0.5 * (t[40] + t[41]), t[99] + 0.03, t[150], t.back()}) {
    const auto row = cubic.row(at);
    REQUIRE(row);
    const SmoothedPoint point = weighted_sums(*row, x);
    const Eigen::Vector4d qr = by_qr(t, x, at, h);
    // Normal equations lose the square of QR's condition, here below 1e4: 1e-16 · 1e8 relative to the sums.
    CHECK(std::abs(point.x_m - qr[0]) < 1e-8 * sum_of_magnitudes(row->weights->x));
    CHECK(std::abs(point.v_m_s - qr[1]) < 1e-8 * sum_of_magnitudes(row->weights->v));
    CHECK(std::abs(point.a_m_s2 - 2.0 * qr[2]) < 1e-8 * sum_of_magnitudes(row->weights->a));
  }
}

TEST_CASE("uniform times are filtered and give what the weights of each point give") {
  const auto t = uniform_times(400, 0.005);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto x = sampled(t, [&](double) { return noise(random); });
  const double h = 0.031;  // 6 h is no whole number of steps: both sides cut off at the same points
  const LocalCubic cubic(t, h);
  const auto smoothed = cubic.smooth(x);
  CHECK(cubic.row_of_point(100)->weights == cubic.row_of_point(300)->weights);  // one filter for all
  for (std::size_t j = 0; j < t.size(); ++j) {
    const Eigen::Vector4d qr = by_qr(t, x, t[j], h);
    REQUIRE(smoothed[j]);
    const auto weights = cubic.row_of_point(j)->weights;
    CHECK(std::abs(smoothed[j]->x_m - qr[0]) < 1e-8 * sum_of_magnitudes(weights->x));
    CHECK(std::abs(smoothed[j]->v_m_s - qr[1]) < 1e-8 * sum_of_magnitudes(weights->v));
    CHECK(std::abs(smoothed[j]->a_m_s2 - 2.0 * qr[2]) < 1e-8 * sum_of_magnitudes(weights->a));
  }
}

TEST_CASE("a missing point within uniform times is smoothed over as the gap that it is") {
  auto t = uniform_times(400, 0.005);
  t.erase(t.begin() + 200);
  const auto x = sampled(t, [](double time) { return 2.0 + time * time * time; });
  const auto smoothed = LocalCubic(t, 0.03).smooth(x);
  for (std::size_t j = 150; j < 250; ++j) CHECK(smoothed[j]->a_m_s2 == Approx(6.0 * t[j]).epsilon(1e-8));  // rounding
}

TEST_CASE("the variance of x, v and a for white noise is that of the closed form") {
  const double dt = 0.005, h = 0.04;
  const LocalCubic cubic(uniform_times(301, dt), h);
  const auto weights = cubic.row_of_point(150)->weights;
  const std::vector<double> white{4.0};
  // The sum over points differs from the integral by exp(-(2 pi h/dt)^2 / 4), nothing at all; the cut at 6 h takes
  // 1e-5.
  const double root_pi = std::sqrt(std::numbers::pi);
  CHECK(noise_variance(weights->x, white) == Approx(4.0 * 27.0 / (32.0 * root_pi) * dt / h).epsilon(1e-4));
  CHECK(noise_variance(weights->v, white) == Approx(4.0 * 55.0 / (64.0 * root_pi) * dt / std::pow(h, 3)).epsilon(1e-4));
  CHECK(noise_variance(weights->a, white) == Approx(4.0 * kGaussianA.variance * dt / std::pow(h, 5)).epsilon(1e-4));
  CHECK(kGaussianA.variance == Approx(3.0 / (8.0 * root_pi)).epsilon(1e-14));
}

TEST_CASE("the bias of x, v and a is that of the closed form where the next derivative is constant") {
  const double dt = 0.005, h = 0.04;
  const auto t = uniform_times(301, dt, -150 * dt);
  const auto quartic = sampled(t, [](double time) { return std::pow(time, 4) / 24.0; });
  const auto quintic = sampled(t, [](double time) { return std::pow(time, 5) / 120.0; });
  const LocalCubic cubic(t, h);
  // At t = 0 all derivatives but the one are zero; the cut at 6 h takes some 1e-5 of the kernel's moments.
  CHECK(cubic.smooth(quartic)[150]->a_m_s2 == Approx(kGaussianA.bias * h * h).epsilon(1e-4));
  CHECK(cubic.smooth(quartic)[150]->x_m == Approx(-std::pow(h, 4) / 8.0).epsilon(1e-4));
  CHECK(cubic.smooth(quintic)[150]->v_m_s == Approx(-std::pow(h, 4) / 8.0).epsilon(1e-4));
}

TEST_CASE("the variance of a sum with correlated noise is w' Sigma w") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> weights(40);
  for (double& w : weights) w = normal(random);
  const std::vector<double> autocovariance{2.0, 1.2, -0.3};
  Eigen::MatrixXd sigma = Eigen::MatrixXd::Zero(40, 40);
  for (int r = 0; r < 40; ++r) {
    for (int c = std::max(0, r - 2); c < std::min(40, r + 3); ++c) {
      sigma(r, c) = autocovariance[static_cast<std::size_t>(std::abs(r - c))];
    }
  }
  const Eigen::Map<const Eigen::VectorXd> w(weights.data(), 40);
  CHECK(noise_variance(weights, autocovariance) == Approx(w.dot(sigma * w)).epsilon(1e-12));  // rounding
}

TEST_CASE("where the kernel holds too few points the local cubic gives nothing") {
  const auto t = uniform_times(50, 0.01);
  CHECK_FALSE(LocalCubic(t, 0.003).row_of_point(25));  // reach 18 ms: three points
  CHECK(LocalCubic(t, 0.006).row_of_point(25));
  CHECK_FALSE(LocalCubic(t, 0.02).row(0.7));  // 0.21 s after the last point, reach 0.12 s
  CHECK_FALSE(LocalCubic(std::vector<double>{0.0, 0.1, 0.2}, 1.0).row_of_point(1));
}
