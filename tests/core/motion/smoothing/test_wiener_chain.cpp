#include "core/motion/smoothing/wiener_chain.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/catch.h"
#include "tests/core/motion/smoothing/dense_wiener.h"

using namespace glidelab::core;
using glidelab::tests::DenseWiener;

namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

/// Steps between 0.4 and 1.6 of 0.1 s, and a hole of 0.8 s.
std::vector<double> uneven_times(std::size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> step(0.04, 0.16);
  std::vector<double> t{3.0};
  while (t.size() < count) t.push_back(t.back() + step(random) + (t.size() == count / 2 ? 0.8 : 0.0));
  return t;
}

std::vector<double> noisy(const std::vector<double>& t, double sd = 1.0) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, sd);
  std::vector<double> y;
  for (const double time : t) y.push_back(20.0 * std::sin(time) + 5.0 * time + noise(random));
  return y;
}

/// A weak and a strong smoothing, with and without breaks, known and any; noise of each point's own.
struct Case {
  double density, jump;
  std::vector<double> breaks;
  bool factors;
};
constexpr double kJumpTime = 0.3;
const std::vector<Case> kCases = {{1e4, kAny, {}, false},     {1.0, kAny, {}, true},
                                  {1e-2, 3.0, {4.53}, false}, {1e2, 30.0, {4.53, 6.0}, true},
                                  {1.0, kAny, {4.53}, false}, {1e3, kAny, {4.2, 6.4}, true}};

template <int N>
struct Made {
  std::vector<double> t, y, factor, at;
  DenseWiener dense;
  WienerChain<N> chain;
};
template <int N>
Made<N> made(const Case& of) {
  std::vector<double> t = uneven_times(36), y = noisy(t), factor;
  for (std::size_t i = 0; of.factors && i < t.size(); ++i) factor.push_back(1.0 + 0.5 * std::sin(double(i)));
  std::vector<double> at{3.5 * t[3] - 2.5 * t[2], t.back() - 1e-3};
  std::sort(at.begin(), at.end());
  const DenseWiener dense(N, t, y, factor, of.density, of.jump, kJumpTime, of.breaks);
  const ChainData data{t, y, factor, of.breaks, at};
  return {t, y, factor, at, dense, WienerChain<N>(data)};
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the chain's posterior and likelihood are those of dense algebra, uneven times and breaks", "",
                       ((int N), N), 3, 4, 5) {
  for (const Case& of : kCases) {
    const Made<N> m = made<N>(of);
    CAPTURE(of.density, of.jump, of.breaks.size());
    const WienerRatio ratio{of.density, of.jump, kJumpTime};
    const ChainPosterior<N> posterior = m.chain.posterior(ratio);
    REQUIRE(posterior.size() == m.t.size() + m.at.size() + 2 * of.breaks.size());
    for (std::size_t k = 0; k < posterior.size(); ++k) {
      // Just before the break is just before; the dense process stands just after it.
      const bool before = k + 1 < posterior.size() && posterior.node(k + 1).after_break;
      const double t = posterior.node(k).t_s - (before ? 1e-12 : 0.0);
      const auto dense = m.dense.at(t);
      CAPTURE(k, t);
      // The dense matrix has a condition of 1e10 or so, of which 1e-16 leaves 1e-6 of a standard deviation's size.
      for (int d = 0; d < 3; ++d) {
        const double sd = std::sqrt(dense.covariance(d, d));
        CHECK(std::abs(posterior.mean(k)[d] - dense.mean[d]) < 1e-5 * sd);
        CHECK(std::abs(posterior.covariance(k)(d, d) - sd * sd) < 1e-5 * sd * sd);
      }
    }
    const ChainFit fit = m.chain.fit(ratio);
    CHECK(fit.freedom == double(m.t.size()) - N - (std::isinf(of.jump) ? (N - 2.0) * double(of.breaks.size()) : 0.0));
    const double whole = fit.minus_two_log_likelihood(1.0) - fit.freedom * std::log(2.0 * M_PI);
    CHECK(std::abs(whole - m.dense.minus_two_log_likelihood()) < 1e-5);
  }
}

TEMPLATE_TEST_CASE_SIG("the chain's rows give its means, and its covariances over two times are the dense ones", "",
                       ((int N), N), 3, 4, 5) {
  for (const Case& of : kCases) {
    const Made<N> m = made<N>(of);
    CAPTURE(of.density, of.jump, of.breaks.size());
    const ChainPosterior<N> posterior = m.chain.posterior({of.density, of.jump, kJumpTime});
    std::vector<std::size_t> all(posterior.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
    const std::vector<KernelRow> rows = posterior.rows(all);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const SmoothedPoint sums = weighted_sums(rows[k], m.y);
      const Eigen::Vector3d sd = posterior.covariance(k).diagonal().template head<3>().cwiseSqrt();
      CHECK(std::abs(sums.x_m - posterior.mean(k)[0]) < 1e-7 * sd[0]);
      CHECK(std::abs(sums.v_m_s - posterior.mean(k)[1]) < 1e-7 * sd[1]);
      CHECK(std::abs(sums.a_m_s2 - posterior.mean(k)[2]) < 1e-7 * sd[2]);
    }
    const std::size_t k = 5, l = 20;
    const auto dense = m.dense.between(posterior.node(k).t_s, posterior.node(l).t_s);
    const Eigen::Vector3d sd_k = posterior.covariance(k).diagonal().template head<3>().cwiseSqrt();
    const Eigen::Vector3d sd_l = posterior.covariance(l).diagonal().template head<3>().cwiseSqrt();
    for (int d = 0; d < 3; ++d) {
      for (int e = 0; e < 3; ++e) {
        CHECK(std::abs(posterior.covariance(k, l)(d, e) - dense.covariance(d, e)) < 1e-5 * sd_k[d] * sd_l[e]);
      }
    }
  }
}

TEST_CASE("with no noise in the law the chain is the least-squares polynomial, with endless noise it interpolates") {
  const std::vector<double> t = uneven_times(40), y = noisy(t);
  const WienerChain<3> chain(ChainData{t, y, {}, {}, {}});
  Eigen::MatrixXd powers(40, 3);
  Eigen::VectorXd right(40);
  for (int i = 0; i < 40; ++i) {
    const double u = t[std::size_t(i)] - t[0];
    powers.row(i) << 1.0, u, u * u;
    right[i] = y[std::size_t(i)];
  }
  const Eigen::VectorXd parabola = powers.colPivHouseholderQr().solve(right);
  const ChainPosterior<3> smooth = chain.posterior({1e-20}), rough = chain.posterior({1e20});
  for (int i = 0; i < 40; ++i) {
    const double u = t[std::size_t(i)] - t[0];
    // q = 1e-20 lets x leave the parabola by q T^5 times its residuals, some 1e-16 of them.
    CHECK(std::abs(smooth.mean(std::size_t(i))[0] - parabola.dot(Eigen::Vector3d(1.0, u, u * u))) < 1e-9);
    CHECK(std::abs(smooth.mean(std::size_t(i))[2] - 2.0 * parabola[2]) < 1e-9);
    // s^2 / (q dt^5) is below 1e-13.
    CHECK(std::abs(rough.mean(std::size_t(i))[0] - y[std::size_t(i)]) < 1e-9);
  }
  CHECK(std::abs(smooth.trace() - 3.0) < 1e-9);
  CHECK(std::abs(rough.trace() - 40.0) < 1e-6);
}

TEST_CASE("far from ends, over even times, neighbours share one row, which gives their means") {
  std::vector<double> t(400);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = 0.01 * double(i);
  const std::vector<double> y = noisy(t);
  const ChainPosterior<3> posterior = WienerChain<3>(ChainData{t, y, {}, {}, {}}).posterior({1e8});
  std::vector<std::size_t> all(t.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  const std::vector<KernelRow> rows = posterior.rows(all);
  CHECK(rows[200].weights.get() == rows[201].weights.get());
  for (std::size_t k = 0; k < all.size(); ++k) {
    CHECK(std::abs(weighted_sums(rows[k], y).a_m_s2 - posterior.mean(k)[2]) <
          1e-5 * std::sqrt(posterior.covariance(k)(2, 2)));
  }
}
