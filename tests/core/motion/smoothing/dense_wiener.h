/// The posterior of an integrated Wiener process by dense linear algebra, O(n^3): the oracle of the state-space engine,
/// from the covariances of the process and with no state.
///
/// With u = t - t_0, w = (x, v, a) at s, m = min(s, t):   cov(x(s), x(t)) = q integral_0^m (s-u)^2 (t-u)^2 / 4 du  and
/// its derivatives; a jump of variance j^2 at t* adds j^2 r(s) r(t), r = (t - t*)_+^2 / 2; x, v and a at t_0, and the
/// jumps that may be any, have a flat prior (universal kriging).
#pragma once

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace glidelab::tests {

/// With jerk = q / s^2 and jump = j / s, at s = 1.
class DenseWiener {
 public:
  DenseWiener(std::vector<double> t_s, std::vector<double> x_m, std::vector<double> factors, double jerk_1_s5,
              double jump_1_s2, std::vector<double> breaks_s)
      : t(std::move(t_s)), y(std::move(x_m)), factor(std::move(factors)), jerk(jerk_1_s5), jump(jump_1_s2),
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
    made.covariance = -cs * ldlt.solve(Eigen::MatrixXd(cr.transpose())) + rest_s * beta_covariance_ * rest_r.transpose();
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
    known_.resize(n, 3 + (std::isinf(jump) ? static_cast<Eigen::Index>(breaks.size()) : 0));
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

  /// (t - from)^(2 - d) / (2 - d)!
  static double power(double since, int derivative) {
    return derivative == 0 ? 0.5 * since * since : derivative == 1 ? since : 1.0;
  }
  double process(int d, double s, int e, double r) const {
    const double from = t.front(), to = std::min(s, r);
    double sum = 0.0;
    if (to > from) {  // four points of Gauss and Legendre: exact to degree 7
      constexpr double kNode[] = {0.3399810435848563, 0.8611363115940526};
      constexpr double kWeight[] = {0.6521451548625461, 0.3478548451374538};
      const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
      for (int i = 0; i < 2; ++i) {
        for (const double side : {-1.0, 1.0}) {
          const double u = middle + side * half * kNode[i];
          sum += jerk * half * kWeight[i] * power(s - u, d) * power(r - u, e);
        }
      }
    }
    if (!std::isinf(jump)) {
      for (const double at : breaks) {
        if (s >= at && r >= at) sum += jump * jump * power(s - at, d) * power(r - at, e);
      }
    }
    return sum;
  }
  Eigen::MatrixXd basis(double s) const {
    Eigen::MatrixXd made = Eigen::MatrixXd::Zero(3, 3 + (std::isinf(jump) ? static_cast<int>(breaks.size()) : 0));
    const double u = s - t.front();
    made.leftCols(3) << 1.0, u, 0.5 * u * u, 0.0, 1.0, u, 0.0, 0.0, 1.0;
    for (int b = 3; b < made.cols(); ++b) {
      const double since = s - breaks[static_cast<std::size_t>(b - 3)];
      for (int d = 0; d < 3 && since >= 0.0; ++d) made(d, b) = power(since, d);
    }
    return made;
  }

  std::vector<double> t, y, factor;
  double jerk, jump;
  std::vector<double> breaks;
  Eigen::MatrixXd covariance_, known_, beta_covariance_;
  Eigen::VectorXd data_, beta_;
};

}  // namespace glidelab::tests
