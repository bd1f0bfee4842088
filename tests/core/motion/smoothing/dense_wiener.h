/// The posterior of an integrated Wiener process by dense linear algebra, O(n^3): the oracle of the state-space engine,
/// from the covariances of the process and with no state.
///
/// With p(u, m) = u^m / m!:   cov(x^(d)(s), x^(e)(t)) = q integral_0^min(s,t) p(s-u, N-1-d) p(t-u, N-1-e) du; a jump of
/// variance j^2 of x^(m) at t* adds j^2 p(s - t*, m-d) p(t - t*, m-e); the state at t_0, and the jumps that may be any,
/// have a flat prior (universal kriging).
#pragma once

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

namespace glidelab::tests {

/// With density = q / s^2 and jump = j / s, at s = 1; the derivative m above a jumps by jump / time^m.
class DenseWiener {
 public:
  DenseWiener(int order, std::vector<double> t_s, std::vector<double> x_m, std::vector<double> factors, double density,
              double jump, double jump_time_s, std::vector<double> breaks_s)
      : n_(order),
        t(std::move(t_s)),
        y(std::move(x_m)),
        factor(std::move(factors)),
        density_(density),
        jump_(jump),
        jump_time_(jump_time_s),
        breaks(std::move(breaks_s)) {
    prepare();
  }

  struct Posterior {
    Eigen::Vector3d mean;
    Eigen::Matrix3d covariance;
  };
  /// Of the process at `at`, just after it (which matters at a break).
  Posterior at(double at_s) const { return between(at_s, at_s); }
  /// The mean at s; the covariance of the states at s and r.
  Posterior between(double s, double r) const {
    const Eigen::MatrixXd solved = covariance_.ldlt().solve(known_);
    Eigen::MatrixXd cs(3, size()), cr(3, size());
    for (int d = 0; d < 3; ++d) {
      for (int i = 0; i < size(); ++i) {
        cs(d, i) = process(d, s, 0, t[static_cast<std::size_t>(i)]);
        cr(d, i) = process(d, r, 0, t[static_cast<std::size_t>(i)]);
      }
    }
    Posterior made;
    const Eigen::MatrixXd rest_s = basis(s) - cs * solved, rest_r = basis(r) - cr * solved;
    const Eigen::VectorXd off = data_ - known_ * beta_;
    const auto ldlt = covariance_.ldlt();
    made.mean = basis(s) * beta_ + cs * ldlt.solve(off);
    made.covariance =
        -cs * ldlt.solve(Eigen::MatrixXd(cr.transpose())) + rest_s * beta_covariance_ * rest_r.transpose();
    for (int d = 0; d < 3; ++d) {
      for (int e = 0; e < 3; ++e) made.covariance(d, e) += process(d, s, e, r);
    }
    return made;
  }
  /// -2 log of the restricted likelihood for s = 1, without its (n - p) log 2 pi.
  double minus_two_log_likelihood() const {
    const Eigen::VectorXd off = data_ - known_ * beta_;
    return log_determinant(covariance_) - log_determinant(beta_covariance_) + off.dot(covariance_.ldlt().solve(off));
  }

 private:
  void prepare() {
    const Eigen::Index n = size();
    if (factor.empty()) factor.assign(t.size(), 1.0);
    covariance_.resize(n, n);
    known_.resize(n, columns());
    data_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      data_[i] = y[k];
      known_.row(i) = basis(t[k]).row(0);
      for (Eigen::Index j = 0; j < n; ++j) covariance_(i, j) = process(0, t[k], 0, t[static_cast<std::size_t>(j)]);
      covariance_(i, i) += factor[k] * factor[k];
    }
    const Eigen::MatrixXd normal = known_.transpose() * covariance_.ldlt().solve(known_);
    beta_covariance_ = normal.inverse();
    beta_ = beta_covariance_ * known_.transpose() * covariance_.ldlt().solve(data_);
  }

  int size() const { return static_cast<int>(t.size()); }
  static double log_determinant(const Eigen::MatrixXd& a) { return a.ldlt().vectorD().array().log().sum(); }

  static double power(double since, int m) { return m < 0 ? 0.0 : m == 0 ? 1.0 : since / m * power(since, m - 1); }
  int columns() const { return n_ + (std::isinf(jump_) ? (n_ - 2) * static_cast<int>(breaks.size()) : 0); }

  double process(int d, double s, int e, double r) const {
    const double from = t.front(), to = std::min(s, r);
    double sum = 0.0;
    if (to > from) {  // five points of Gauss and Legendre: exact to degree 9
      constexpr double kNode[] = {0.0, 0.5384693101056831, 0.9061798459386640};
      constexpr double kWeight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
      const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
      for (int i = -2; i <= 2; ++i) {
        const double u = middle + half * (i < 0 ? -kNode[-i] : kNode[i]);
        sum += density_ * half * kWeight[std::abs(i)] * power(s - u, n_ - 1 - d) * power(r - u, n_ - 1 - e);
      }
    }
    if (!std::isinf(jump_)) {
      for (const double at : breaks) {
        for (int m = 2; m < n_ && s >= at && r >= at; ++m) {
          const double sd = jump_ / std::pow(jump_time_, m - 2);
          sum += sd * sd * power(s - at, m - d) * power(r - at, m - e);
        }
      }
    }
    return sum;
  }
  Eigen::MatrixXd basis(double s) const {
    Eigen::MatrixXd made = Eigen::MatrixXd::Zero(3, columns());
    for (int d = 0; d < 3; ++d) {
      for (int m = 0; m < n_; ++m) made(d, m) = power(s - t.front(), m - d);
      for (int column = n_; column < columns(); ++column) {
        const double since = s - breaks[static_cast<std::size_t>((column - n_) / (n_ - 2))];
        if (since >= 0.0) made(d, column) = power(since, 2 + (column - n_) % (n_ - 2) - d);
      }
    }
    return made;
  }

  int n_;
  std::vector<double> t, y, factor;
  double density_, jump_, jump_time_;
  std::vector<double> breaks;
  Eigen::MatrixXd covariance_, known_, beta_covariance_;
  Eigen::VectorXd data_, beta_;
};

}  // namespace glidelab::tests
