/// Local polynomials on an even grid, eight neighbouring points at a time.
///
/// Far from an end all points share one set of weights: a filter. At an end the window of point i is cut off `before`
/// steps to its left and `after` steps to its right, and its weights are its own; but they need not be known. With
/// s = u / h, w_d the kernel at d steps and s_d the place there, the cubic  sum_k c_k s^k  solves
///
///     sum_l S_(k+l) c_l = M_k,   S_k = sum_d w_d s_d^k (k = 0 … 6),   M_k = sum_d w_d s_d^k y_(i+d) (k = 0 … 3),
///
/// with d = -before … after. All S_k come from one table of sums over d = 1 … m, so that a point costs its four M_k and
/// a symmetric system of four. The condition of the S_(k+l), scaled to a diagonal of 1, is below 1200 for a Gaussian of
/// one step or more that is cut off on one side at its middle; the sums lose three digits there.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/math/simd.h"

namespace glidelab::core {

inline constexpr std::size_t kGridLanes = 8;
using GridLanes = std::array<double, kGridLanes>;

/// x, v and a of eight neighbouring points.
struct GridBlock {
  GridLanes x{}, v{}, a{};
  std::array<bool, kGridLanes> determined{};
};

/// The weights of the filter from its middle on: x and a are even in the lag, v is odd. All of one length.
struct GridFilter {
  std::span<const double> x, v, a;
};

/// The filter's sums for the points at middle[0] … middle[7]; as many values must lie to the left of the first and to
/// the right of the last as the filter has lags.
GridBlock filter_block(const GridFilter& filter, const double* middle, base::Simd simd = base::Simd::best);

/// The local cubic where windows are cut off.
class GridEnds {
 public:
  /// Of the kernel at 0, 1, … steps, of which each has the length `step` in bandwidths.
  GridEnds(std::span<const double> kernel, double step, double bandwidth_s);

  /// The largest lag.
  std::size_t lags() const { return moments_[0].size() - 1; }

  /// For the values at middle[0] … middle[7], with lags() values at either side of which those outside of a point's
  /// window are 0. A point whose window determines the cubic badly is not `determined`: the system's pivots are below
  /// 1e-4 of its diagonal.
  GridBlock solve(const double* middle, const std::array<std::size_t, kGridLanes>& before,
                  const std::array<std::size_t, kGridLanes>& after, base::Simd simd = base::Simd::best) const;

 private:
  double bandwidth_s_ = 0.0;
  std::array<std::vector<double>, 4> weighted_;  // w_d s_d^k at d = 0, 1, …
  std::array<std::vector<double>, 7> moments_;   // sums of w_d s_d^k over d = 1 … m, at m = 0, 1, …
};

}  // namespace glidelab::core
