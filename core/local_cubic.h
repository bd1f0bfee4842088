/// The local cubic with a Gaussian kernel: x, v and a at a time from measured positions (paper, equations 10 to 12).
///
/// At a time t the polynomial  d + c u + b u^2 + a u^3,  u = t_i - t  (the paper's sign turned, so that c is v), is
/// fitted to the positions x_i with the weights exp(-u^2 / (2 h^2)); then x = d, v = c, a = 2 b. All three are linear
/// in the x_i, and the weights of the sums are exact for any times: not uniform, with gaps, at an end.
///
/// The kernel is cut off at kKernelReach = 6 bandwidths, where its weight is 1.5e-8 and what is left out changes a by
/// less than 1e-5 of the kernel's own smoothing. With uniform times of step dt, far from an end and for h of several dt
/// (white noise of standard deviation s; Fan and Gijbels 1996, section 3.2):
///
///     var x = 0.4760 s^2 dt / h      var v = 0.4849 s^2 dt / h^3     var a = 0.2116 s^2 dt / h^5
///     bias x = -h^4 x''''/8          bias v = -h^4 x'''''/8          bias a = h^2 x''''/2
///
/// Where many points of uniform step are smoothed the weights are one filter, applied as such.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace glidelab::core {

/// Bandwidths at which the Gaussian kernel is cut off.
inline constexpr double kKernelReach = 6.0;

/// Coefficients of var a = c s^2 dt / h^5 and of bias a = c h^2 x'''' (see above): 3 / (8 sqrt(pi)) and 1/2.
inline constexpr double kAccelerationVariance = 0.21157109383040862;
inline constexpr double kAccelerationBias = 0.5;

/// x = sum_i x[i] x_(first+i), and v and a likewise; all three of one length.
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
  double a_m_s2 = 0.0;
};

/// The smoother of one set of times. Units are those of a position; any other series over the same times will do.
class LocalCubic {
 public:
  /// Times that rise strictly, bandwidth above 0 (asserted).
  LocalCubic(std::span<const double> t_s, double bandwidth_s);

  /// The weights at any time; nothing where fewer than five points lie within reach or they do not determine a cubic.
  std::optional<KernelRow> row(double at_s) const;
  /// The same at the time of point j, cheap where the filter serves.
  std::optional<KernelRow> row_of_point(std::size_t j) const;

  /// At the times of all points; values.size() is that of the times (asserted).
  std::vector<std::optional<SmoothedPoint>> smooth(std::span<const double> values) const;

  double bandwidth_s() const { return bandwidth_s_; }
  std::span<const double> times() const { return t_s_; }

 private:
  std::optional<KernelRow> general_row(double at_s) const;
  bool interior(std::size_t j) const;
  void filter(std::span<const double> values, std::size_t from, std::size_t to,
              std::vector<std::optional<SmoothedPoint>>& out) const;

  std::vector<double> t_s_;
  double bandwidth_s_ = 0.0;
  std::size_t half_ = 0;                         // taps to each side of the filter; 0 where there is none
  std::vector<std::size_t> run_;                 // run_[j]: points before j that follow each other at the uniform step
  std::shared_ptr<const KernelWeights> filter_;  // weights of 2 half_ + 1 points
};

/// The sums of a row over `values`, which are those of all points.
SmoothedPoint weighted_sums(const KernelRow& row, std::span<const double> values);

/// Variance of sum_i w_i n_i for noise n with the autocovariance gamma[0], gamma[1], … at lags of 0, 1, … points.
double noise_variance(std::span<const double> weights, std::span<const double> autocovariance);

/// The variances of rows by one noise; points that share a filter share the work.
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

}  // namespace glidelab::core
