/// Local polynomials: x, v and a at a given time from measured positions, by a kernel (paper, equations 10 to 12, for
/// any order and kernel).
///
/// At a time t the polynomial  sum_k b_k u^k / k!,  u = t_i - t,  k = 0 … order,  is fitted to the positions x_i with
/// the weights w_i K(u / h); then x = b_0, v = b_1, a = b_2. All three are linear in the x_i, and the weights of the
/// sums are exact for any times: non-uniform, with gaps, at an end. Kernels (unnormalised; s = u / h):
///
///     gaussian      exp(-s^2 / 2)      cut off at `reach` bandwidths (6: a weight of 1.5e-8)
///     epanechnikov  1 - s^2            |s| < 1
///     tricube       (1 - |s|^3)^3      |s| < 1
///     uniform       1                  |s| <= 1
///     bimodal       s^2 exp(-s^2)      cut off likewise; a point has no weight in its own value (for bandwidth rules)
///
/// The weights come from the polynomials p_k that are orthogonal over the points under these weights (least_squares.h),
///
///     b_d = sum_k p_k^(d)(0) sum_i K_i p_k(u_i) x_i / sum_i K_i p_k(u_i)^2,
///
/// which needs no matrix and loses no digits at an end, where powers of u are nearly equal. If many points of uniform
/// step and weight are smoothed, the weights are one filter, applied as such, and a cubic at an end comes from moments
/// of its window (grid_block.h), the same to rounding.
///
/// Covariances are exact for noise of a given autocovariance, white or not, times a factor for each point. Asymptotic
/// variance and bias: docs/guide/bandwidth.md; Fan and Gijbels 1996, section 3.2.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/long_work.h"

namespace glidelab::core {

class GridEnds;

/// Bandwidths at which the Gaussian kernel is cut off.
inline constexpr double kKernelReach = 6.0;

enum class Kernel { gaussian, epanechnikov, tricube, uniform, bimodal };

/// K(s), 0 outside of the kernel's support; the Gaussian is not cut off here.
double kernel_value(Kernel kernel, double s);

struct PolynomialOptions {
  int order = 3;  ///< 1 to 5
  Kernel kernel = Kernel::gaussian;
  double bandwidth_s = 0.0;     ///< above 0
  double reach = kKernelReach;  ///< of the Gaussian and the bimodal kernel, in bandwidths
  std::vector<double> weights;  ///< of each point, above 0; empty: all the same
};

/// x = sum_i x[i] x_(first+i), and v and a likewise; all three of one length, a empty for order 1.
struct KernelWeights {
  std::vector<double> x, v, a;
};
struct KernelRow {
  std::size_t first = 0;
  std::shared_ptr<const KernelWeights> weights;
};

struct SmoothedPoint {
  double x_m = 0.0;
  double v_m_s = 0.0;
  double a_m_s2 = 0.0;  ///< NaN for order 1, which has none
};

/// The smoother of one set of times. Units are those of a position; any other series over the same times can be
/// smoothed.
class LocalPolynomial {
 public:
  /// Times that rise strictly; options in their range (asserted).
  LocalPolynomial(std::span<const double> t_s, PolynomialOptions options);

  /// The weights at any time; empty if fewer than order + 2 points lie within reach or they do not determine the
  /// polynomial.
  std::optional<KernelRow> row(double at_s) const;
  /// The same at the time of point j; cheap if the filter applies.
  std::optional<KernelRow> row_of_point(std::size_t j) const;

  /// At the times of all points; values.size() is that of the times (asserted).
  std::vector<std::optional<SmoothedPoint>> smooth(std::span<const double> values,
                                                   const base::StopCheck& stop_check = base::never_stop) const;

  double bandwidth_s() const { return options_.bandwidth_s; }
  const PolynomialOptions& options() const { return options_; }
  std::span<const double> times() const { return t_s_; }

 private:
  std::optional<KernelRow> general_row(double at_s, std::optional<std::size_t> point = {}) const;
  bool interior(std::size_t j) const;
  bool cut_off(std::size_t j) const;
  void filter(std::span<const double> values, std::size_t from, std::size_t to,
              std::vector<std::optional<SmoothedPoint>>& out) const;
  void fit_end(const GridEnds& ends, std::span<const double> values, std::size_t from, std::size_t to,
               std::vector<std::optional<SmoothedPoint>>& out, const base::StopCheck& stop_check) const;

  std::vector<double> t_s_;
  PolynomialOptions options_;
  double reach_s_ = 0.0;
  std::size_t half_ = 0;                         // taps on each side of the filter; 0 if there is none
  std::vector<std::size_t> run_;                 // run_[j]: number of consecutive points before j at the uniform step
  std::vector<double> kernel_;                   // at whole uniform steps, if there are any
  std::shared_ptr<const KernelWeights> filter_;  // weights of 2 half_ + 1 points
  double step_s_ = 0.0;                          // the uniform step, where a cubic comes from moments
  std::size_t steps_within_ = 0;                 // steps within reach; 0 where it does not
};

/// The sums of a row over `values`, given at all points.
SmoothedPoint weighted_sums(const KernelRow& row, std::span<const double> values);

/// Noise of the positions: cov(n_i, n_j) = factor_i factor_j gamma(|i - j|), gamma 0 beyond its last lag.
struct SeriesNoise {
  std::vector<double> autocovariance;  ///< at lags of 0, 1, … points; a single number if the noise is white
  std::vector<double> factor;          ///< of every point; empty: 1
};

/// Covariance of sum_i w_i n_(first+i) for two rows of weights.
double noise_covariance(std::size_t first, std::span<const double> weights, std::size_t other_first,
                        std::span<const double> other, const SeriesNoise& noise);

/// Covariance of (x, v, a) at one time (rows) with (x, v, a) at another (columns). Needs order 2 or more (asserted).
Eigen::Matrix3d point_covariance(const KernelRow& row, const KernelRow& other, const SeriesNoise& noise);

/// Variance of sum_i w_i n_i for noise n with the autocovariance gamma[0], gamma[1], … at lags of 0, 1, … points.
double noise_variance(std::span<const double> weights, std::span<const double> autocovariance);

/// The variances of rows for one noise; points that share a filter share the work.
class RowVariance {
 public:
  explicit RowVariance(std::vector<double> autocovariance) : autocovariance_(std::move(autocovariance)) {}
  double of_x(const KernelRow& row) { return of(row).x; }
  double of_v(const KernelRow& row) { return of(row).v; }
  double of_a(const KernelRow& row) { return of(row).a; }

 private:
  struct Variances {
    double x = 0.0, v = 0.0, a = 0.0;
  };
  const Variances& of(const KernelRow& row);
  std::vector<double> autocovariance_;
  std::shared_ptr<const KernelWeights> known_;
  Variances variances_;
};

/// The local cubic with a Gaussian kernel, which is the paper's case (equations 10 to 12): the smoother of one set of
/// times, which rise strictly; bandwidth above 0 (asserted). u = t_i - t has the opposite sign to the paper's, so that
/// c is v.
///
/// The kernel is cut off at kKernelReach = 6 bandwidths, where its weight is 1.5e-8; the omitted part changes a by less
/// than 1e-5 of the kernel's own smoothing. With uniform times of step dt, far from an end and for h of several dt
/// (white noise of standard deviation s; Fan and Gijbels 1996, section 3.2):
///
///     var x = 0.4760 s^2 dt / h      var v = 0.4849 s^2 dt / h^3     var a = 0.2116 s^2 dt / h^5
///     bias x = -h^4 x''''/8          bias v = -h^4 x'''''/8          bias a = h^2 x''''/2
class LocalCubic : public LocalPolynomial {
 public:
  LocalCubic(std::span<const double> t_s, double bandwidth_s) : LocalPolynomial(t_s, options_of(bandwidth_s)) {}

 private:
  static PolynomialOptions options_of(double bandwidth_s) {
    PolynomialOptions options;
    options.bandwidth_s = bandwidth_s;
    return options;
  }
};

/// Asymptotic constants of the local cubic (order 3), from which bandwidth rules follow.
///
/// For uniform times of step dt, white noise of variance s^2 and h of several steps, far from an end, the estimate of
/// the d-th derivative by the equivalent kernel K_d (Fan and Gijbels 1996, section 3.2.2) has
///
///     bias = B_d h^(4-d) x''''    variance = R_d s^2 dt / h^(2d+1)    (d = 0 and 2, where 3 - d is odd)
///
/// so the mean square error is least at  h^9 = (2d+1) R_d / (2 (4-d) B_d^2) · s^2 dt / x''''^2.
///
///     Gaussian, K = exp(-u^2/2)/sqrt(2 pi):   K_0 = (3 - u^2)/2 K      B_0 = -1/8   R_0 = 27/(32 sqrt(pi))
///                                             K_2 = (u^2 - 1) K        B_2 =  1/2   R_2 = 3/(8 sqrt(pi))
///     bimodal, K = 2 u^2 exp(-u^2)/sqrt(pi):  K_0 = (5/2 - u^2) K      B_0 = -5/32  R_0 = 105/(64 sqrt(2 pi))
///
/// For a (d = 2) that is h^9 = 5 R_2 s^2 dt / x''''^2 = 1.058 s^2 dt / x''''^2.
struct KernelConstants {
  int derivative = 0;
  double bias = 0.0;      ///< B_d
  double variance = 0.0;  ///< R_d

  /// h^9 x''''^2 / (s^2 dt) at the least mean square error.
  double best_h9() const { return (2 * derivative + 1) * variance / (2.0 * (4 - derivative) * bias * bias); }
};

inline constexpr KernelConstants kGaussianX{0, -0.125, 27.0 / 32.0 * std::numbers::inv_sqrtpi};
inline constexpr KernelConstants kGaussianA{2, 0.5, 3.0 / 8.0 * std::numbers::inv_sqrtpi};
inline constexpr KernelConstants kBimodalX{0, -5.0 / 32.0,
                                           105.0 / 64.0 * std::numbers::inv_sqrtpi / std::numbers::sqrt2};

/// The bandwidth that is optimal for `wanted` if h is optimal for `given`, with the same x'''' and noise.
inline double convert_bandwidth(double h, const KernelConstants& given, const KernelConstants& wanted) {
  return h * std::pow(wanted.best_h9() / given.best_h9(), 1.0 / 9.0);
}

/// Minimum of the residual squares criterion s^2 (1 + 4 V) + bias part (Fan and Gijbels 1995): its h^9 x''''^2/(s^2
/// dt). The residuals' bias part is C (x''''/4!)^2 h^8 with C = 4! = the norm of the Hermite polynomial He_4; so 8 C
/// (x''''/24)^2 h^7 = 4 R_0 s^2 dt / h^2.
inline constexpr double kResidualSquaresH9 = 4.0 * kGaussianX.variance * 24.0 * 24.0 / (8.0 * 24.0);

}  // namespace glidelab::core
