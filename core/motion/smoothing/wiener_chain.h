/// The integrated Wiener process of order N through noisy positions: the one engine of the Kalman smoother and of the
/// smoothing spline.
///
/// The state is x and its derivatives x^(0) … x^(N-1), for N = 3 (x, v, a); the derivative above, x^(N), is white noise
/// of density q:
///
///     dx^(k) = x^(k+1) dt,   dx^(N-1) = sqrt(q) dW,        y_i = x(t_i) + n_i,   n_i ~ N(0, (s f_i)^2),
///
/// with nothing known about the state at the start. With a rate k, x^(N-1) decays (dx^(N-1) = -k x^(N-1) dt + …): for N
/// = 3 that is the integrated Ornstein-Uhlenbeck process, whose motion without noise is that under constant and viscous
/// friction. Steps of any length are exact (process_step.h), for times of any spacing, including times at which nothing
/// was measured. At a break x and v are continuous, while a jumps by N(0, j^2), taking along what decays with it, and
/// the m-th derivative above it jumps by an additional N(0, (j / u^m)^2); for infinite j all jumps are free. The
/// posterior mean is the smoothing spline of degree 2N - 1 that makes
///
///     sum ((y_i - x(t_i)) / f_i)^2 + (s^2 / q) integral (x^(N))^2 dt
///
/// least (Wahba 1978, J. R. Stat. Soc. B 40, 364; Wecker and Ansley 1983, J. Am. Stat. Assoc. 78, 81).
///
/// Computed in O(n) by a square-root information filter (Bierman 1977, chapters V and X): every step is a QR
/// decomposition of 2N rows, so that neither an unknown start nor q near 0 costs digits, and the eliminated rows are
/// the smoother,
///
///     state_k = G_k state_(k+1) + g_k + noise of covariance D_k.
///
/// All below is in units of s: the likelihood and the covariances follow for any s. N is 3, 4 or 5.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {

/// The strength of the smoothing in units of the noise.
struct WienerRatio {
  double density = 0.0;                                        ///< q / s^2, above 0, in s^(1 - 2N)
  double jump_1_s2 = std::numeric_limits<double>::infinity();  ///< j / s, of each break; infinite: any jump
  double jump_time_s = 1.0;                                    ///< u
  double rate_1_s = 0.0;                                       ///< k, at which x^(N-1) decays
};

/// A time of a chain: of a measured position, of a break, or one at which the motion is requested.
struct ChainNode {
  double t_s = 0.0;
  std::optional<std::size_t> point;  ///< the point whose position it holds
  bool after_break = false;          ///< a jumps between the previous node (at the same time) and this one
};

/// Positions of one continuous motion. Times rise strictly.
struct ChainData {
  std::span<const double> t_s;
  std::span<const double> x_m;
  std::span<const double> factor;  ///< f of each position, above 0; empty: 1
  std::vector<double> breaks_s;    ///< rising, each with N positions before and after
  std::vector<double> at_s;        ///< rising: other requested times
};

/// Sums from which marginal likelihoods are formed; those of several chains add up.
struct ChainFit {
  double freedom = 0.0;          ///< number of positions minus that of the unknown parameters: N, and the free jumps
  double squares_m2 = 0.0;       ///< of the whitened innovations at s = 1
  double log_determinant = 0.0;  ///< of their covariance at s = 1

  ChainFit& operator+=(const ChainFit& other);
  /// s^2 of maximum likelihood.
  double noise_variance() const { return squares_m2 / freedom; }
  /// -2 log of the (restricted, for the diffuse start) marginal likelihood, with s^2 = `noise_variance_m2`.
  double minus_two_log_likelihood(double noise_variance_m2) const;
};

/// Mean and covariance (at s = 1) of the states at the chain's nodes, and the correlations between them.
template <int N>
class ChainPosterior {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  std::size_t size() const { return mean_.size(); }
  const ChainNode& node(std::size_t k) const { return nodes_[k]; }
  const Vector& mean(std::size_t k) const { return mean_[k]; }
  const Matrix& covariance(std::size_t k) const { return covariance_[k]; }

  /// Covariance (at s = 1) of state k with state l.
  Matrix covariance(std::size_t k, std::size_t l) const;

  /// The same of state k with state k + 1.
  Matrix covariance_with_next(std::size_t k) const { return gain_[k] * covariance_[k + 1]; }

  /// The weights of the positions in x, v and a of node k, over the chain's points: the posterior mean is linear in
  /// them, and dE[state_k]/dy_i = cov(state_k, x_i) / f_i^2. Weights that fade below 1e-10 of the largest are cut off.
  /// Over uniform steps far from ends and breaks, neighbours share one set.
  std::vector<KernelRow> rows(const std::vector<std::size_t>& nodes) const;

  /// Sum over the positions of their own weight in x: the effective number of parameters.
  double trace() const;
  /// Sum of ((y - x)/f)^2.
  double residual_squares_m2() const;

  /// One draw of (state - mean) at every node, at s = 1.
  template <typename Normal>
  std::vector<Vector> draw(Normal&& normal) const;

 private:
  template <int M>
  friend class WienerChain;
  std::vector<ChainNode> nodes_;
  std::vector<Vector> mean_;
  std::vector<Matrix> covariance_;
  std::vector<Matrix> gain_, root_;  // G_k, and a root of D_k
  Matrix last_root_ = Matrix::Zero();
  std::vector<double> x_m_, factor_;  // of the chain's points
};

template <int N>
class WienerChain {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  /// At least N positions (asserted).
  explicit WienerChain(const ChainData& data);

  const std::vector<ChainNode>& nodes() const { return nodes_; }
  ChainFit fit(const WienerRatio& ratio) const;
  ChainPosterior<N> posterior(const WienerRatio& ratio) const;

 private:
  struct Step;
  template <typename Visit>
  ChainFit filter(const WienerRatio& ratio, Matrix& last, Vector& right, Visit&& visit) const;

  std::vector<ChainNode> nodes_;
  std::vector<double> x_m_, factor_;
  double origin_m_ = 0.0;
  double unit_s_ = 1.0;  // internal unit of time: the mean step
};

template <int N>
template <typename Normal>
std::vector<Eigen::Matrix<double, N, 1>> ChainPosterior<N>::draw(Normal&& normal) const {
  std::vector<Vector> off(size());
  const auto draws = [&] {
    Vector values;
    for (int i = 0; i < N; ++i) values[i] = normal();
    return values;
  };
  off.back() = last_root_ * draws();
  for (std::size_t k = size() - 1; k-- > 0;) off[k] = gain_[k] * off[k + 1] + root_[k] * draws();
  return off;
}

extern template class WienerChain<3>;
extern template class WienerChain<4>;
extern template class WienerChain<5>;
extern template class ChainPosterior<3>;
extern template class ChainPosterior<4>;
extern template class ChainPosterior<5>;

}  // namespace glidelab::core
