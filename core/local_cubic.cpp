#include "core/local_cubic.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestPoints = 5;       // four coefficients and one point for their noise
constexpr double kSmallestReciprocal = 1e-11;  // condition at which the moments of a double carry no cubic
constexpr double kUniform = 1e-9;              // steps that differ by less than this part are one step

/// The weights of the points t[0..n) about the time `at`; false where they do not determine a cubic.
bool cubic_weights(std::span<const double> t_s, double at_s, double bandwidth_s, KernelWeights& weights) {
  const std::size_t n = t_s.size();
  std::array<double, 7> moment{};
  std::vector<double> kernel(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double u = (t_s[i] - at_s) / bandwidth_s;
    double term = std::exp(-0.5 * u * u);
    kernel[i] = term;
    for (double& m : moment) {
      m += term;
      term *= u;
    }
  }
  Eigen::Matrix4d normal;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) normal(r, c) = moment[static_cast<std::size_t>(r + c)];
  }
  // Scaling by the diagonal makes the condition that of the points' places, not of the kernel's size.
  const Eigen::Vector4d scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return false;
  const Eigen::PartialPivLU<Eigen::Matrix4d> lu(scale.asDiagonal() * normal * scale.asDiagonal());
  if (!(lu.rcond() > kSmallestReciprocal)) return false;
  const Eigen::Matrix4d inverse = scale.asDiagonal() * lu.inverse() * scale.asDiagonal();
  const double per_h = 1.0 / bandwidth_s;
  weights.x.resize(n);
  weights.v.resize(n);
  weights.a.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double u = (t_s[i] - at_s) * per_h;
    const Eigen::Vector4d powers(1.0, u, u * u, u * u * u);
    weights.x[i] = kernel[i] * inverse.row(0).dot(powers);
    weights.v[i] = kernel[i] * per_h * inverse.row(1).dot(powers);
    weights.a[i] = kernel[i] * 2.0 * per_h * per_h * inverse.row(2).dot(powers);
  }
  return true;
}

}  // namespace

LocalCubic::LocalCubic(std::span<const double> t_s, double bandwidth_s)
    : t_s_(t_s.begin(), t_s.end()), bandwidth_s_(bandwidth_s) {
  assert(bandwidth_s > 0.0);
  if (t_s_.size() < kFewestPoints) return;
  const double step = median_step(t_s_);
  if (!(step > 0.0)) return;
  const auto half = static_cast<std::size_t>(std::min(kKernelReach * bandwidth_s / step * (1.0 + kUniform), 1e9));
  run_.assign(t_s_.size(), 0);
  std::size_t longest = 0;
  for (std::size_t j = 1; j < t_s_.size(); ++j) {
    if (std::abs(t_s_[j] - t_s_[j - 1] - step) <= kUniform * step) run_[j] = run_[j - 1] + 1;
    longest = std::max(longest, run_[j]);
  }
  if (half < 2 || longest < 2 * half) return;
  std::vector<double> about(2 * half + 1);
  for (std::size_t i = 0; i < about.size(); ++i) about[i] = (static_cast<double>(i) - static_cast<double>(half)) * step;
  auto weights = std::make_shared<KernelWeights>();
  if (!cubic_weights(about, 0.0, bandwidth_s, *weights)) return;
  half_ = half;
  filter_ = std::move(weights);
}

bool LocalCubic::interior(std::size_t j) const {
  return half_ > 0 && j >= half_ && j + half_ < t_s_.size() && run_[j + half_] >= 2 * half_;
}

std::optional<KernelRow> LocalCubic::general_row(double at_s) const {
  const double reach = kKernelReach * bandwidth_s_ * (1.0 + kUniform);
  const auto first = std::lower_bound(t_s_.begin(), t_s_.end(), at_s - reach);
  const auto last = std::upper_bound(first, t_s_.end(), at_s + reach);
  if (last - first < static_cast<std::ptrdiff_t>(kFewestPoints)) return {};
  auto weights = std::make_shared<KernelWeights>();
  if (!cubic_weights(std::span(first, last), at_s, bandwidth_s_, *weights)) return {};
  return KernelRow{static_cast<std::size_t>(first - t_s_.begin()), std::move(weights)};
}

std::optional<KernelRow> LocalCubic::row(double at_s) const {
  const auto found = std::lower_bound(t_s_.begin(), t_s_.end(), at_s);
  if (found != t_s_.end() && *found == at_s) return row_of_point(static_cast<std::size_t>(found - t_s_.begin()));
  return general_row(at_s);
}

std::optional<KernelRow> LocalCubic::row_of_point(std::size_t j) const {
  assert(j < t_s_.size());
  if (interior(j)) return KernelRow{j - half_, filter_};
  return general_row(t_s_[j]);
}

void LocalCubic::filter(std::span<const double> values, std::size_t from, std::size_t to,
                        std::vector<std::optional<SmoothedPoint>>& out) const {
  constexpr std::size_t kBlock = 512;  // outputs at a time: the three sums stay in the cache while the taps go by
  std::array<double, kBlock> x{}, v{}, a{};
  const double* const wx = filter_->x.data() + half_;
  const double* const wv = filter_->v.data() + half_;
  const double* const wa = filter_->a.data() + half_;
  for (std::size_t start = from; start < to; start += kBlock) {
    const std::size_t count = std::min(kBlock, to - start);
    const double* const centre = values.data() + start;
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = wx[0] * centre[i];
      v[i] = 0.0;
      a[i] = wa[0] * centre[i];
    }
    for (std::size_t k = 1; k <= half_; ++k) {  // x and a are even in the lag, v is odd
      const double* const right = centre + k;
      const double* const left = centre - k;
      const double cx = wx[k], cv = wv[k], ca = wa[k];
      for (std::size_t i = 0; i < count; ++i) {
        const double sum = right[i] + left[i];
        x[i] += cx * sum;
        v[i] += cv * (right[i] - left[i]);
        a[i] += ca * sum;
      }
    }
    for (std::size_t i = 0; i < count; ++i) out[start + i] = SmoothedPoint{x[i], v[i], a[i]};
  }
}

std::vector<std::optional<SmoothedPoint>> LocalCubic::smooth(std::span<const double> values) const {
  assert(values.size() == t_s_.size());
  std::vector<std::optional<SmoothedPoint>> out(t_s_.size());
  for (std::size_t j = 0; j < t_s_.size();) {
    if (interior(j)) {
      std::size_t to = j + 1;
      while (to < t_s_.size() && interior(to)) ++to;
      filter(values, j, to, out);
      j = to;
      continue;
    }
    if (const auto row = general_row(t_s_[j])) out[j] = weighted_sums(*row, values);
    ++j;
  }
  return out;
}

SmoothedPoint weighted_sums(const KernelRow& row, std::span<const double> values) {
  const KernelWeights& weights = *row.weights;
  assert(row.first + weights.x.size() <= values.size());
  // About the first value, so that a far origin costs no digits.
  const double origin = values[row.first];
  SmoothedPoint point;
  for (std::size_t i = 0; i < weights.x.size(); ++i) {
    const double value = values[row.first + i] - origin;
    point.x_m += weights.x[i] * value;
    point.v_m_s += weights.v[i] * value;
    point.a_m_s2 += weights.a[i] * value;
  }
  point.x_m += origin;
  return point;
}

double noise_variance(std::span<const double> weights, std::span<const double> autocovariance) {
  double variance = 0.0;
  for (std::size_t lag = 0; lag < autocovariance.size() && lag < weights.size(); ++lag) {
    double product = 0.0;
    for (std::size_t i = 0; i + lag < weights.size(); ++i) product += weights[i] * weights[i + lag];
    variance += (lag == 0 ? 1.0 : 2.0) * autocovariance[lag] * product;
  }
  return variance;
}

const RowVariance::Variances& RowVariance::of(const KernelRow& row) {
  if (row.weights != known_) {
    known_ = row.weights;
    variances_ = {noise_variance(known_->x, autocovariance_), noise_variance(known_->v, autocovariance_),
                  noise_variance(known_->a, autocovariance_)};
  }
  return variances_;
}

}  // namespace glidelab::core
