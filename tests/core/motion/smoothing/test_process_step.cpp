#include "core/motion/smoothing/process_step.h"

#include <Eigen/Dense>

#include <cmath>
#include <vector>

#include "core/motion/smoothing/wiener_chain.h"
#include "tests/catch.h"

using namespace glidelab::core;

namespace {

template <int N>
using Matrix = Eigen::Matrix<double, N, N>;

template <int N>
Matrix<N> covariance(const ProcessStep<N>& step) {
  return step.root * step.root.transpose();
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("two steps of a process are one of their length, whatever the rate", "", ((int N), N), 3, 4, 5) {
  // |k h| from next to nothing, over where the roots are interpolated, to several e-folds, of both signs.
  for (const double rate : {0.0, 1e-9, 0.05, -0.05, 0.3, 2.0, -1.0}) {
    CAPTURE(rate);
    constexpr double kFirst = 0.7, kSecond = 1.9;
    ProcessSteps<N> steps(rate);
    const ProcessStep<N> first = steps.of(kFirst), second = steps.of(kSecond), whole = steps.of(kFirst + kSecond);
    const Matrix<N> back = first.back * second.back;
    CHECK((back - whole.back).norm() < 1e-13 * whole.back.norm());
    const Matrix<N> onwards = second.back.inverse();
    const Matrix<N> sum = onwards * covariance<N>(first) * onwards.transpose() + covariance<N>(second);
    const Matrix<N> of_whole = covariance<N>(whole);
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) {
        CHECK(std::abs(sum(i, j) - of_whole(i, j)) < 1e-11 * std::sqrt(of_whole(i, i) * of_whole(j, j)));
      }
    }
  }
}

TEST_CASE("a step without a rate is that of the Wiener process, one with a rate that of Ornstein and Uhlenbeck") {
  const double h = 0.3;
  const Matrix<4> wiener = covariance<4>(ProcessSteps<4>(0.0).of(h));
  constexpr double kFactorial[] = {1.0, 1.0, 2.0, 6.0};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const int m = 7 - i - j;
      CHECK(wiener(i, j) == Approx(std::pow(h, m) / (m * kFactorial[3 - i] * kFactorial[3 - j])).epsilon(1e-12));
    }
  }
  for (const double k : {0.1, 4.0, -2.0}) {
    const ProcessStep<3> step = ProcessSteps<3>(k).of(h);
    CHECK(covariance<3>(step)(2, 2) == Approx(-std::expm1(-2.0 * k * h) / (2.0 * k)).epsilon(1e-12));
    const Matrix<3> onwards = step.back.inverse();
    CHECK(onwards(2, 2) == Approx(std::exp(-k * h)).epsilon(1e-12));
    CHECK(onwards(1, 2) == Approx(-std::expm1(-k * h) / k).epsilon(1e-12));
    CHECK(onwards(0, 2) == Approx((h + std::expm1(-k * h) / k) / k).epsilon(1e-11));
  }
}

TEST_CASE("with no noise in the law a chain with a rate is the fit of a line and an exponential, its likelihood too") {
  constexpr double kRate = 2.0;
  std::vector<double> t, y;
  Eigen::MatrixXd known(40, 3);
  Eigen::VectorXd right(40);
  for (int i = 0; i < 40; ++i) {
    const double at = 0.05 * i + (i % 3 == 1 ? 0.013 : 0.0);
    t.push_back(at);
    y.push_back(3.0 - at + std::exp(-1.7 * at) + 0.01 * std::cos(37.0 * at));
    // What the state at the start, of which nothing is known, makes of x.
    known.row(i) << 1.0, at, (at + std::expm1(-kRate * at) / kRate) / kRate;
    right[i] = y.back();
  }
  const Eigen::VectorXd solved = known.colPivHouseholderQr().solve(right);
  const double squares = (right - known * solved).squaredNorm();
  const double log_determinant = std::log((known.transpose() * known).determinant());
  const WienerChain<3> chain(ChainData{t, y, {}, {}, {}});
  WienerRatio ratio{1e-20};
  ratio.rate_1_s = kRate;
  const ChainFit fit = chain.fit(ratio);
  CHECK(fit.squares_m2 == Approx(squares).epsilon(1e-9));
  CHECK(fit.log_determinant == Approx(log_determinant).epsilon(1e-9));
  const ChainPosterior<3> posterior = chain.posterior(ratio);
  for (std::size_t i = 0; i < t.size(); ++i) {
    CHECK(std::abs(posterior.mean(i)[2] - solved[2] * std::exp(-kRate * t[i])) < 1e-9);
  }
}

TEST_CASE(
    "a chain over even times that settles has the likelihood and the states of the same one with a step that differs") {
  // Two of 2000 steps are written apart by a time at which nothing is measured: the filter cannot settle across it.
  std::vector<double> t, y;
  for (int i = 0; i < 2000; ++i) {
    t.push_back(0.01 * i);
    y.push_back(std::sin(3.0 * t.back()) + 1e-3 * std::cos(1e3 * t.back()));
  }
  std::vector<double> between;
  for (std::size_t i = 0; i + 1 < t.size(); i += 2) between.push_back(0.5 * (t[i] + t[i + 1]));
  const WienerChain<4> even(ChainData{t, y, {}, {}, {}}), parted(ChainData{t, y, {}, {}, between});
  WienerRatio ratio{1e9};
  ratio.rate_1_s = 0.4;
  const ChainFit settled = even.fit(ratio), full = parted.fit(ratio);
  CHECK(settled.squares_m2 == Approx(full.squares_m2).epsilon(1e-8));
  CHECK(settled.log_determinant == Approx(full.log_determinant).epsilon(1e-9));
  const ChainPosterior<4> of_even = even.posterior(ratio), of_parted = parted.posterior(ratio);
  for (std::size_t k = 0; k < of_parted.size(); ++k) {
    if (!of_parted.node(k).point) continue;
    const std::size_t i = *of_parted.node(k).point;
    const double sd = std::sqrt(of_parted.covariance(k)(2, 2));
    CHECK(std::abs(of_even.mean(i)[2] - of_parted.mean(k)[2]) < 1e-6 * sd);
    CHECK(std::abs(of_even.covariance(i)(2, 2) - sd * sd) < 1e-6 * sd * sd);
  }
}
