#include "diagnose/noise/noise_likelihood.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math/dense.h"

namespace glidelab::diagnose {
namespace {

constexpr double kOwn = 0.3;  // motions differ by so much, in the logarithm of s

// Of such a codec, measured on clips with nothing wrong whose truth is known (H.264 of crf 14 to 18, seeds 3000 to
// 8000, tracked positions less the true ones): neighbours correlate by 0.15 to 0.35, every other frame by 0.3 to 0.4,
// the fourth by 0.1 to 0.3, the eighth by 0 to 0.15. That is a part that lasts, 0.8 of s, for some five frames; clips
// differ by a factor of about 1.6. The positions themselves have the last word.
constexpr double kLasts = 0.8, kLastsFactor = 0.5;  // over s; in its logarithm

}  // namespace

NoiseLikelihood::NoiseLikelihood(std::vector<NoiseChunk> chunks, std::size_t motions, double pilot_px, bool handed_on)
    : chunks_(std::move(chunks)), motions_(motions), pilot_px_(pilot_px), handed_on_(handed_on) {}

double NoiseLikelihood::known(const NoiseShape& shape) const {
  if (!handed_on_) return 0.0;
  constexpr double kAsGoodAsNone = 0.1;
  return -0.5 * std::pow(std::log(std::max(shape.lasting, kAsGoodAsNone) / kLasts) / kLastsFactor, 2);
}

Likelihood NoiseLikelihood::of(const NoiseShape& shape) const {
  std::vector<Left> left(motions_);
  for (const NoiseChunk& chunk : chunks_) left[chunk.motion] = with(chunk, shape, left[chunk.motion]);
  Likelihood found;
  double log_s = std::log(pilot_px_);
  std::vector<double> own(motions_, log_s);
  for (int round = 0; round < 8; ++round) {
    double mean = 0.0, many = 0.0;
    for (std::size_t i = 0; i < motions_; ++i) {
      own[i] = log_s;
      if (left[i].freedom <= 0.0) continue;
      // Newton's steps for the largest of -freedom log s_i - square/(2 s_i²) - (log(s_i/s)/kOwn)²/2.
      for (int step = 0; step < 12; ++step) {
        const double over = left[i].square * std::exp(-2.0 * own[i]);
        const double slope = -left[i].freedom + over - (own[i] - log_s) / (kOwn * kOwn);
        own[i] += std::clamp(slope / (2.0 * over + 1.0 / (kOwn * kOwn)), -0.5, 0.5);
      }
      mean += own[i];
      many += 1.0;
    }
    if (many > 0.0) log_s = mean / many;
  }
  found.value = known(shape);
  for (std::size_t i = 0; i < motions_; ++i) {
    found.value -= left[i].freedom * own[i] + 0.5 * left[i].square * std::exp(-2.0 * own[i]) + 0.5 * left[i].logs +
                   0.5 * std::pow((own[i] - log_s) / kOwn, 2);
    found.own_px.push_back(std::exp(own[i]));
  }
  found.white_px = std::exp(log_s);
  return found;
}

NoiseLikelihood::Left NoiseLikelihood::with(const NoiseChunk& chunk, const NoiseShape& shape, Left left) const {
  const Eigen::Index n = chunk.off_px.size(), k = chunk.slow.cols();
  const Eigen::MatrixXd lower = base::cholesky_lower(covariance_of(chunk.frames, shape, pilot_px_));
  Eigen::MatrixXd both(n, k + 1);
  both << chunk.slow, chunk.off_px;
  both = base::solve_lower(lower, both);
  left.logs += 2.0 * lower.diagonal().array().log().sum();
  const Eigen::MatrixXd normal = base::transposed_product(both, both);
  // The last pivot's square is what the slow columns leave of the residuals; the others' make log |B'V^-1 B|.
  const Eigen::MatrixXd factor = base::cholesky_lower(normal);
  left.square += factor(k, k) * factor(k, k);
  for (Eigen::Index c = 0; c < k; ++c) left.logs += 2.0 * std::log(factor(c, c));
  left.freedom += static_cast<double>(n - k);
  return left;
}

}  // namespace glidelab::diagnose
