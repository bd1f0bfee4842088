#include "core/math/least_squares.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <limits>

namespace glidelab::core {
namespace {

constexpr double kSmallestNorm = 1e-11;  // of p_k over that of u^k: a double's digits carry no such power

}  // namespace

std::optional<OrthogonalPolynomials> OrthogonalPolynomials::make(int order, std::span<const double> u,
                                                                 std::span<const double> weights) {
  assert(order >= 0 && u.size() == weights.size());
  const std::size_t n = u.size();
  OrthogonalPolynomials made;
  made.points_ = n;
  const auto polynomials = static_cast<std::size_t>(order) + 1;
  made.values_.resize(n * polynomials);
  for (std::vector<double>* numbers : {&made.norm_, &made.alpha_, &made.beta_}) numbers->reserve(polynomials);
  using Numbers = Eigen::Map<const Eigen::ArrayXd>;
  const auto count = static_cast<Eigen::Index>(n);
  const Numbers at(u.data(), count), weight(weights.data(), count);
  Eigen::ArrayXd power = weight;  // K u^(2k)
  double* now = made.values_.data();
  std::fill_n(now, n, 1.0);
  for (int k = 0;; ++k) {
    const Numbers p(now, count);
    const double norm = (weight * p.square()).sum(), first = (weight * p.square() * at).sum(), of_power = power.sum();
    power *= at.square();
    if (!(norm > kSmallestNorm * of_power)) return {};
    made.norm_.push_back(norm);
    if (k == order) return made;
    const double alpha = first / norm;
    const double beta = k == 0 ? 0.0 : norm / made.norm_[static_cast<std::size_t>(k) - 1];
    made.alpha_.push_back(alpha);
    made.beta_.push_back(beta);
    const double* const before = k == 0 ? now : now - n;  // beta is 0 for the first
    double* const next = now + n;
    for (std::size_t i = 0; i < n; ++i) next[i] = (u[i] - alpha) * now[i] - beta * before[i];
    now = next;
  }
}

std::vector<double> OrthogonalPolynomials::derivatives(double u, int highest) const {
  const auto stride = static_cast<std::size_t>(highest) + 1;
  std::vector<double> all(norm_.size() * stride, 0.0);
  all[0] = 1.0;
  for (std::size_t k = 0; k + 1 < norm_.size(); ++k) {
    const double* const p = all.data() + k * stride;
    const double* const before = k == 0 ? p : p - stride;
    double* const next = all.data() + (k + 1) * stride;
    for (std::size_t d = 0; d < stride; ++d) {
      next[d] = (u - alpha_[k]) * p[d] - beta_[k] * before[d] + (d > 0 ? static_cast<double>(d) * p[d - 1] : 0.0);
    }
  }
  return all;
}

Eigen::VectorXd damped_step(const Eigen::Ref<const Eigen::MatrixXd>& jtj, const Eigen::Ref<const Eigen::VectorXd>& jtr,
                            double damping) {
  Eigen::MatrixXd damped = jtj;
  damped.diagonal() *= 1.0 + damping;
  damped.diagonal().array() += 1e-12 * jtj.diagonal().maxCoeff();
  return -damped.ldlt().solve(jtr);
}

std::optional<Eigen::MatrixXd> inverse_of_equations(const Eigen::Ref<const Eigen::MatrixXd>& jtj) {
  // Singularity as judged by FullPivLU: for a matrix without negative eigenvalues both choose the same pivots.
  const Eigen::LDLT<Eigen::MatrixXd> factor(jtj);
  const auto pivots = factor.vectorD().cwiseAbs();
  const auto size = static_cast<double>(jtj.rows());
  if (!(pivots.minCoeff() > size * std::numeric_limits<double>::epsilon() * pivots.maxCoeff())) return {};
  return factor.solve(Eigen::MatrixXd::Identity(jtj.rows(), jtj.cols()));
}

}  // namespace glidelab::core
