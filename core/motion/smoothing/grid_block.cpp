#include "core/motion/smoothing/grid_block.h"

#include <cassert>

namespace glidelab::core {
namespace {

constexpr double kLeastPivot = 1e-4;  // of the diagonal: rounding is then below 1e-12 of the moments

struct Moments {
  std::array<GridLanes, 4> of_values;  // M_k
  std::array<GridLanes, 7> of_kernel;  // S_k
};

/// The sum and the difference of the values at a lag on both sides serve all sums.
[[gnu::always_inline]] inline void filter_lanes(const GridFilter& filter, const double* middle, GridBlock& block) {
  GridLanes x, v{}, a;
  for (std::size_t i = 0; i < kGridLanes; ++i) {
    x[i] = filter.x[0] * middle[i];
    a[i] = filter.a[0] * middle[i];
  }
  for (std::size_t k = 1; k < filter.x.size(); ++k) {
    const double* const right = middle + k;
    const double* const left = middle - k;
    const double cx = filter.x[k], cv = filter.v[k], ca = filter.a[k];
    for (std::size_t i = 0; i < kGridLanes; ++i) {
      const double sum = right[i] + left[i];
      x[i] += cx * sum;
      v[i] += cv * (right[i] - left[i]);
      a[i] += ca * sum;
    }
  }
  block.x = x;
  block.v = v;
  block.a = a;
}

[[gnu::always_inline]] inline void sum_lanes(const std::array<std::vector<double>, 4>& weighted, const double* middle,
                                             std::array<GridLanes, 4>& sums) {
  GridLanes m0, m1{}, m2{}, m3{};
  for (std::size_t i = 0; i < kGridLanes; ++i) m0[i] = weighted[0][0] * middle[i];
  const double *const w0 = weighted[0].data(), *const w1 = weighted[1].data(), *const w2 = weighted[2].data(),
                      *const w3 = weighted[3].data();
  for (std::size_t k = 1; k < weighted[0].size(); ++k) {
    const double* const right = middle + k;
    const double* const left = middle - k;
    for (std::size_t i = 0; i < kGridLanes; ++i) {
      const double sum = right[i] + left[i], difference = right[i] - left[i];
      m0[i] += w0[k] * sum;
      m1[i] += w1[k] * difference;
      m2[i] += w2[k] * sum;
      m3[i] += w3[k] * difference;
    }
  }
  sums = {m0, m1, m2, m3};
}

/// S = L D L', forward, and backward to the three coefficients that are wanted.
[[gnu::always_inline]] inline void solve_lanes(const Moments& of, double bandwidth_s, GridBlock& block) {
  const auto& [m0, m1, m2, m3] = of.of_values;
  const auto& [s0, s1, s2, s3, s4, s5, s6] = of.of_kernel;
  for (std::size_t i = 0; i < kGridLanes; ++i) {
    const double r0 = 1.0 / s0[i];
    const double l1 = s1[i] * r0, l2 = s2[i] * r0, l3 = s3[i] * r0;
    const double d1 = s2[i] - l1 * s1[i], r1 = 1.0 / d1;
    const double b12 = s3[i] - l1 * s2[i], b13 = s4[i] - l1 * s3[i];
    const double l12 = b12 * r1, l13 = b13 * r1;
    const double d2 = s4[i] - l2 * s2[i] - l12 * b12, r2 = 1.0 / d2;
    const double b23 = s5[i] - l2 * s3[i] - l12 * b13;
    const double l23 = b23 * r2;
    const double d3 = s6[i] - l3 * s3[i] - l13 * b13 - l23 * b23;
    const double y1 = m1[i] - l1 * m0[i];
    const double y2 = m2[i] - l2 * m0[i] - l12 * y1;
    const double y3 = m3[i] - l3 * m0[i] - l13 * y1 - l23 * y2;
    const double c3 = y3 / d3;
    const double c2 = y2 * r2 - l23 * c3;
    const double c1 = y1 * r1 - l12 * c2 - l13 * c3;
    block.x[i] = m0[i] * r0 - l1 * c1 - l2 * c2 - l3 * c3;
    block.v[i] = c1 / bandwidth_s;
    block.a[i] = 2.0 * c2 / (bandwidth_s * bandwidth_s);
    block.determined[i] = d1 > kLeastPivot * s2[i] && d2 > kLeastPivot * s4[i] && d3 > kLeastPivot * s6[i];
  }
}

void filter_baseline(const GridFilter& filter, const double* middle, GridBlock& block) {
  filter_lanes(filter, middle, block);
}

void sums_baseline(const std::array<std::vector<double>, 4>& weighted, const double* middle,
                   std::array<GridLanes, 4>& sums) {
  sum_lanes(weighted, middle, sums);
}

void solve_baseline(const Moments& of, double bandwidth_s, GridBlock& block) {
  solve_lanes(of, bandwidth_s, block);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations on more lanes.
[[gnu::target("avx2")]] void filter_avx2(const GridFilter& filter, const double* middle, GridBlock& block) {
  filter_lanes(filter, middle, block);
}

[[gnu::target("avx2")]] void sums_avx2(const std::array<std::vector<double>, 4>& weighted, const double* middle,
                                       std::array<GridLanes, 4>& sums) {
  sum_lanes(weighted, middle, sums);
}

[[gnu::target("avx2")]] void solve_avx2(const Moments& of, double bandwidth_s, GridBlock& block) {
  solve_lanes(of, bandwidth_s, block);
}
#endif

}  // namespace

GridBlock filter_block(const GridFilter& filter, const double* middle, [[maybe_unused]] base::Simd simd) {
  assert(!filter.x.empty() && filter.v.size() == filter.x.size() && filter.a.size() == filter.x.size());
  GridBlock block;
  block.determined.fill(true);
#if defined(__x86_64__)
  if (base::uses_avx2(simd)) {
    filter_avx2(filter, middle, block);
    return block;
  }
#endif
  filter_baseline(filter, middle, block);
  return block;
}

GridEnds::GridEnds(std::span<const double> kernel, double step, double bandwidth_s) : bandwidth_s_(bandwidth_s) {
  assert(!kernel.empty() && step > 0.0 && bandwidth_s > 0.0);
  for (auto& of_power : weighted_) of_power.resize(kernel.size());
  for (auto& of_power : moments_) of_power.resize(kernel.size());
  std::array<double, 7> sums{};
  for (std::size_t d = 0; d < kernel.size(); ++d) {
    const double s = static_cast<double>(d) * step;
    double of_power = kernel[d];
    for (std::size_t k = 0; k < moments_.size(); ++k) {
      if (k < weighted_.size()) weighted_[k][d] = of_power;
      if (d > 0) sums[k] += of_power;
      moments_[k][d] = sums[k];
      of_power *= s;
    }
  }
}

GridBlock GridEnds::solve(const double* middle, const std::array<std::size_t, kGridLanes>& before,
                          const std::array<std::size_t, kGridLanes>& after, [[maybe_unused]] base::Simd simd) const {
  Moments of;
  for (std::size_t k = 0; k < moments_.size(); ++k) {
    const double* const sum = moments_[k].data();
    const double here = k == 0 ? weighted_[0][0] : 0.0, sign = k % 2 == 0 ? 1.0 : -1.0;
    for (std::size_t i = 0; i < kGridLanes; ++i) of.of_kernel[k][i] = here + sum[after[i]] + sign * sum[before[i]];
  }
  GridBlock block;
#if defined(__x86_64__)
  if (base::uses_avx2(simd)) {
    sums_avx2(weighted_, middle, of.of_values);
    solve_avx2(of, bandwidth_s_, block);
    return block;
  }
#endif
  sums_baseline(weighted_, middle, of.of_values);
  solve_baseline(of, bandwidth_s_, block);
  return block;
}

}  // namespace glidelab::core
