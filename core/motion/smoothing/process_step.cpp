#include "core/motion/smoothing/process_step.h"

#include <Eigen/Core>

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "base/math/dense.h"

namespace glidelab::core {
namespace {

/// Lengths that differ by less than this fraction count as equal: uniform times differ by that much as doubles.
constexpr double kOneLength = 1e-9;
/// Nodes of the quadrature: exact for polynomials of degree 29, and to 1e-16 for |k h| up to 4.
constexpr unsigned kNodes = 15;

double factorial(int n) {
  return n < 2 ? 1.0 : n * factorial(n - 1);
}

/// phi_m(z), 0 <= m <= N - 1: the last by its series, the others from phi_m = z phi_(m+1) + 1/m!; for large z in upward
/// recurrence.
template <int N>
Eigen::Matrix<double, N, 1> phi(double z) {
  Eigen::Matrix<double, N, 1> made;
  constexpr double kSeries = 2.0;
  if (std::abs(z) < kSeries) {
    double term = 1.0 / factorial(N - 1), sum = term;
    for (int j = 1; std::abs(term) > 1e-17 * sum; ++j) sum += term *= z / (j + N - 1);
    made[N - 1] = sum;
    for (int m = N - 2; m >= 0; --m) made[m] = z * made[m + 1] + 1.0 / factorial(m);
    return made;
  }
  made[0] = std::exp(z);
  for (int m = 1; m < N; ++m) made[m] = (made[m - 1] - 1.0 / factorial(m - 1)) / z;
  return made;
}

template <int N>
Eigen::Matrix<double, N, N> transition(double h, double rate) {
  Eigen::Matrix<double, N, N> f = Eigen::Matrix<double, N, N>::Identity();
  const Eigen::Matrix<double, N, 1> last = phi<N>(-rate * h);
  for (int i = 0; i < N; ++i) {
    double power = 1.0;
    for (int j = i + 1; j < N; ++j) f(i, j) = power *= h / (j - i);
    f(i, N - 1) = std::pow(h, N - 1 - i) * last[N - 1 - i];
  }
  return f;
}

/// The root for h = 1.
template <int N>
Eigen::Matrix<double, N, N> unit_root(double rate) {
  using Rule = boost::math::quadrature::gauss<double, kNodes>;
  Eigen::MatrixXd rows(kNodes, N);  // the last state first: its root is lower triangular, and upper once the order is
                                    // restored
  int filled = 0;
  const auto add = [&](double at, double weight) {
    const Eigen::Matrix<double, N, 1> f = phi<N>(-rate * at);
    double scale = std::sqrt(weight);
    for (int m = 0; m < N; ++m, scale *= at) rows(filled, m) = scale * f[m];
    ++filled;
  };
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    const double off = Rule::abscissa()[i], weight = 0.5 * Rule::weights()[i];
    add(0.5 * (1.0 + off), weight);
    if (off != 0.0) add(0.5 * (1.0 - off), weight);
  }
  return base::upper_factor(rows).transpose().reverse();
}

/// The root for h = 1 as a polynomial of k h, for |k h| up to kSmall: non-uniform times need it at every step. Its
/// derivatives are of order 1, so that the interpolation error is below 1e-16.
template <int N>
class SmallRoot {
 public:
  static constexpr double kSmall = 0.1;

  SmallRoot() {
    Eigen::MatrixXd powers(kTerms, kTerms), values(kTerms, N * N);
    for (int i = 0; i < kTerms; ++i) {
      const double at = std::cos(std::numbers::pi * (i + 0.5) / kTerms);
      for (int j = 0; j < kTerms; ++j) powers(i, j) = std::pow(at, j);
      values.row(i) = unit_root<N>(kSmall * at).reshaped().transpose();
    }
    const Eigen::MatrixXd solved = base::least_squares(powers, values);
    for (int j = 0; j < kTerms; ++j) coefficient_[j] = solved.row(j).reshaped(N, N);
  }

  Eigen::Matrix<double, N, N> at(double rate) const {
    const double u = rate / kSmall;
    Eigen::Matrix<double, N, N> sum = coefficient_[kTerms - 1];
    for (int j = kTerms - 2; j >= 0; --j) sum = u * sum + coefficient_[j];
    return sum;
  }

 private:
  static constexpr int kTerms = 9;
  std::array<Eigen::Matrix<double, N, N>, kTerms> coefficient_;
};

template <int N>
Eigen::Matrix<double, N, N> noise_root(double h, double rate) {
  static const SmallRoot<N> small;
  const double z = rate * h;
  Eigen::Matrix<double, N, N> root = std::abs(z) <= SmallRoot<N>::kSmall ? small.at(z) : unit_root<N>(z);
  double scale = std::sqrt(h);
  for (int i = N - 1; i >= 0; --i, scale *= h) root.row(i) *= scale;
  return root;
}

}  // namespace

template <int N>
const ProcessStep<N>& ProcessSteps<N>::of(double h) {
  if (std::abs(h - length_) > kOneLength * h) {
    length_ = h;
    step_.back = transition<N>(-h, rate_);
    step_.root = noise_root<N>(h, rate_);
  }
  return step_;
}

template class ProcessSteps<3>;
template class ProcessSteps<4>;
template class ProcessSteps<5>;

}  // namespace glidelab::core
