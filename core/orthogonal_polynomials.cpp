#include "core/orthogonal_polynomials.h"

#include <algorithm>
#include <cassert>

#include "core/strands.h"

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
  made.values_.resize(n * (static_cast<std::size_t>(order) + 1));
  std::vector<double> power(weights.begin(), weights.end());  // K u^(2k)
  double* now = made.values_.data();
  std::fill_n(now, n, 1.0);
  for (int k = 0;; ++k) {
    const auto [norm, first, of_power] = sums_in_strands<3>(n, [&](std::size_t i) {
      const double square = weights[i] * now[i] * now[i], of_this = power[i];
      power[i] = of_this * (u[i] * u[i]);
      return std::array{square, square * u[i], of_this};
    });
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

}  // namespace glidelab::core
