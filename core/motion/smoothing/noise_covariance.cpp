// What the noise of positions makes of sums over a kernel.
#include <algorithm>
#include <cassert>

#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {

double noise_variance(std::span<const double> weights, std::span<const double> autocovariance) {
  double variance = 0.0;
  for (std::size_t lag = 0; lag < autocovariance.size() && lag < weights.size(); ++lag) {
    const auto count = static_cast<Eigen::Index>(weights.size() - lag);
    using Numbers = Eigen::Map<const Eigen::VectorXd>;
    const double product = Numbers(weights.data(), count).dot(Numbers(weights.data() + lag, count));
    variance += (lag == 0 ? 1.0 : 2.0) * autocovariance[lag] * product;
  }
  return variance;
}

double noise_covariance(std::size_t first, std::span<const double> weights, std::size_t other_first,
                        std::span<const double> other, const SeriesNoise& noise) {
  const auto factor = [&](std::size_t point) { return noise.factor.empty() ? 1.0 : noise.factor[point]; };
  const auto lags = static_cast<std::ptrdiff_t>(noise.autocovariance.size());
  const auto from = static_cast<std::ptrdiff_t>(other_first), count = static_cast<std::ptrdiff_t>(other.size());
  double covariance = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto point = static_cast<std::ptrdiff_t>(first + i);
    const std::ptrdiff_t begin = std::max(from, point - lags + 1), end = std::min(from + count, point + lags);
    double sum = 0.0;
    for (std::ptrdiff_t p = begin; p < end; ++p) {
      const auto lag = static_cast<std::size_t>(p > point ? p - point : point - p);
      sum +=
          noise.autocovariance[lag] * factor(static_cast<std::size_t>(p)) * other[static_cast<std::size_t>(p - from)];
    }
    covariance += weights[i] * factor(first + i) * sum;
  }
  return covariance;
}

Eigen::Matrix3d point_covariance(const KernelRow& row, const KernelRow& other, const SeriesNoise& noise) {
  assert(!row.weights->a.empty() && !other.weights->a.empty());
  const std::vector<double>* const left[] = {&row.weights->x, &row.weights->v, &row.weights->a};
  const std::vector<double>* const right[] = {&other.weights->x, &other.weights->v, &other.weights->a};
  Eigen::Matrix3d covariance;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) covariance(r, c) = noise_covariance(row.first, *left[r], other.first, *right[c], noise);
  }
  return covariance;
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
