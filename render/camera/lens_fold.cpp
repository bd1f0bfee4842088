// Where a lens folds over: fold_radius() of lens.h.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "render/camera/lens.h"

namespace glidelab::render {
namespace {

using Polynomial = std::vector<double>;  // coefficients, the constant first

double value(const Polynomial& p, double s) {
  double sum = 0.0;
  for (std::size_t i = p.size(); i-- > 0;) sum = sum * s + p[i];
  return sum;
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial out(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) out[i + j] += a[i] * b[j];
  }
  return out;
}

/// s times the derivative.
Polynomial turned(const Polynomial& p) {
  Polynomial out = p;
  for (std::size_t i = 0; i < p.size(); ++i) out[i] = static_cast<double>(i) * p[i];
  return out;
}

Polynomial sum(const Polynomial& a, double factor, const Polynomial& b) {
  Polynomial out(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) out[i] += a[i];
  for (std::size_t i = 0; i < b.size(); ++i) out[i] += factor * b[i];
  return out;
}

/// The positive real zeros, rising: eigenvalues of the companion matrix.
std::vector<double> positive_zeros(Polynomial p) {
  while (!p.empty() && p.back() == 0.0) p.pop_back();
  if (p.size() < 2) return {};
  const auto degree = static_cast<Eigen::Index>(p.size() - 1);
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  for (Eigen::Index i = 0; i < degree; ++i) {
    companion(i, degree - 1) = -p[static_cast<std::size_t>(i)] / p.back();
    if (i > 0) companion(i, i - 1) = 1.0;
  }
  constexpr double kReal = 1e-6;  // a double zero splits by the root of the rounding
  std::vector<double> zeros;
  const Eigen::VectorXcd all = Eigen::EigenSolver<Eigen::MatrixXd>(companion, false).eigenvalues();
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    const std::complex<double> z = all[i];
    if (z.real() > 0.0 && std::abs(z.imag()) <= kReal * std::abs(z)) zeros.push_back(z.real());
  }
  std::sort(zeros.begin(), zeros.end());
  return zeros;
}

/// The smallest s > 0 at which a polynomial that is positive at 0 becomes negative; infinity where it does not. A zero
/// that it only touches does not count.
double first_crossing(const Polynomial& p) {
  const std::vector<double> zeros = positive_zeros(p);
  double low = 0.0;
  for (std::size_t i = 0; i < zeros.size(); ++i) {
    const double beyond = i + 1 < zeros.size() ? 0.5 * (zeros[i] + zeros[i + 1]) : 2.0 * zeros[i];
    if (value(p, beyond) > 0.0) {
      low = beyond;
      continue;
    }
    double high = beyond;
    for (int k = 0; k < 200 && high - low > 1e-15 * high; ++k) {
      const double middle = 0.5 * (low + high);
      (value(p, middle) > 0.0 ? low : high) = middle;
    }
    return low;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double fold_radius(const Lens& lens) {
  if (lens.model == LensModel::fisheye) {
    // d theta_d / d theta in q = theta².
    const double q = first_crossing({1.0, 3.0 * lens.k1, 5.0 * lens.k2, 7.0 * lens.k3, 9.0 * lens.k4});
    const double theta = std::sqrt(q);
    return theta < 0.5 * std::numbers::pi ? std::tan(theta) : std::numeric_limits<double>::infinity();
  }
  const Polynomial above{1.0, lens.k1, lens.k2, lens.k3};
  if (lens.model == LensModel::brown_conrady) {
    return std::sqrt(first_crossing(sum(above, 2.0, turned(above))));
  }
  // d(r N/D)/dr = ((N + 2 s N') D - 2 s N D') / D², s = r².
  const Polynomial below{1.0, lens.k4, lens.k5, lens.k6};
  const Polynomial slope = sum(product(sum(above, 2.0, turned(above)), below), -2.0, product(above, turned(below)));
  return std::sqrt(std::min(first_crossing(slope), first_crossing(below)));
}

}  // namespace glidelab::render
