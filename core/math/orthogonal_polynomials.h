/// Polynomials that are orthogonal over given points and weights (Forsythe 1957): least squares without matrices.
///
///     p_0 = 1,   p_(k+1)(u) = (u - alpha_k) p_k(u) - beta_k p_(k-1)(u)
///     alpha_k = sum K u p_k^2 / N_k,   beta_k = N_k / N_(k-1),   N_k = sum K p_k^2
///
/// The weighted fit of values y is  sum_k c_k p_k,  c_k = sum K p_k y / N_k; the c_k of white noise of unit variance
/// and K = 1 are independent, of variance 1 / N_k. u is best scaled to about 1.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

class OrthogonalPolynomials {
 public:
  /// Nothing where the points carry no polynomial of the order: a norm below 1e-11 of that of the power u^k.
  static std::optional<OrthogonalPolynomials> make(int order, std::span<const double> u,
                                                   std::span<const double> weights);

  int order() const { return static_cast<int>(norm_.size()) - 1; }
  double norm(int k) const { return norm_[static_cast<std::size_t>(k)]; }
  /// p_k at the points.
  std::span<const double> at_points(int k) const {
    return std::span(values_).subspan(static_cast<std::size_t>(k) * points_, points_);
  }
  /// The derivatives 0 … highest of all p_k at u: [k * (highest + 1) + d].
  std::vector<double> derivatives(double u, int highest) const;

 private:
  std::size_t points_ = 0;
  std::vector<double> values_, norm_, alpha_, beta_;
};

}  // namespace glidelab::core
