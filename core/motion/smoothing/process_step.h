/// One step of the process of wiener_chain.h: a chain of N - 1 integrators behind a derivative that decays at a rate k,
///
///     dx^(d) = x^(d+1) dt   (d < N - 1),      dx^(N-1) = -k x^(N-1) dt + sqrt(q) dW.
///
/// With phi_0(z) = e^z and phi_m(z) = sum_j z^j / (j + m)!, over a step h, exactly,
///
///     F_ij = h^(j-i) / (j-i)!  (j < N - 1),     F_i,N-1 = f_(N-1-i)(h),     f_m(s) = s^m phi_m(-k s),
///     cov(w_i, w_j) = q integral_0^h f_(N-1-i)(s) f_(N-1-j)(s) ds.
///
/// For k = 0 that is the integrated Wiener process of order N. The root of the covariance is computed from
/// Gauss-Legendre nodes without forming the covariance, so that no digits are lost.
#pragma once

#include <Eigen/Core>

namespace glidelab::core {

template <int N>
struct ProcessStep {
  using Matrix = Eigen::Matrix<double, N, N>;
  Matrix back;  ///< F(h)^-1 = F(-h)
  Matrix root;  ///< an upper triangle R with R R' = cov w for q = 1
};

/// Steps for one rate; neighbouring steps of equal length share the work.
template <int N>
class ProcessSteps {
 public:
  explicit ProcessSteps(double rate) : rate_(rate) {}
  /// h above 0, in the unit of time of the rate.
  const ProcessStep<N>& of(double h);

 private:
  double rate_, length_ = 0.0;
  ProcessStep<N> step_;
};

extern template class ProcessSteps<3>;
extern template class ProcessSteps<4>;
extern template class ProcessSteps<5>;

}  // namespace glidelab::core
