#include "fit/trajectory/trajectory_uncertainty.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math/dense.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"

namespace glidelab::fit {
namespace {

using base::product;
using base::transposed_product;

constexpr double kCondition = 1e-13;  // reciprocal, of the scaled normal matrix
constexpr std::size_t kFewestPieces = 8;
constexpr std::size_t kFewestBlocks = 4;

/// Autocovariance of lag i times the vector: Gamma w.
Eigen::VectorXd times_noise(const std::vector<double>& autocovariance, const Eigen::VectorXd& w) {
  Eigen::VectorXd product = autocovariance.front() * w;
  for (Eigen::Index lag = 1; lag < static_cast<Eigen::Index>(autocovariance.size()) && lag < w.size(); ++lag) {
    const double gamma = autocovariance[static_cast<std::size_t>(lag)];
    product.tail(w.size() - lag) += gamma * w.head(w.size() - lag);
    product.head(w.size() - lag) += gamma * w.tail(w.size() - lag);
  }
  return product;
}

/// Number of points worth an independent one, from the noise's autocovariance.
double independent(const FitBlock& fit, double points) {
  double sum = 1.0;
  for (std::size_t lag = 1; lag < fit.autocovariance_m2.size(); ++lag) {
    sum += 2.0 * std::pow(fit.autocovariance_m2[lag] / fit.autocovariance_m2.front(), 2);
  }
  return points / sum;
}

}  // namespace

double variance_of(const FitBlock& fit) {
  return std::max(fit.autocovariance_m2.front(), kLeastVariance);
}

TrajectoryUncertainty::TrajectoryUncertainty(const std::vector<FitBlock>& blocks, const std::vector<Linearised>& at,
                                             int free)
    : blocks_(blocks), at_(at) {
  normal_ = Eigen::MatrixXd::Zero(free, free);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Linearised& of = at[b];
    const auto common = of.common.leftCols(free);
    // The part of the derivatives that no start x0, v0 can take up.
    const Eigen::MatrixXd projected = common - product(of.start, base::least_squares(of.start, common));
    normal_ += transposed_product(projected, projected) / variance_of(blocks[b]);
    projected_.push_back(projected);
  }
  const Eigen::VectorXd scale = normal_.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal_ * scale.asDiagonal();
  if (!(base::symmetric_eigen(scaled).values[0] > kCondition)) return;
  inverse_ = scale.asDiagonal() * base::inverse_positive(scaled) * scale.asDiagonal();
}

void TrajectoryUncertainty::fill(TrajectoryFit& fit) const {
  const Eigen::Index free = inverse_.rows();
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(free, free);
  double chi2 = 0.0, count = 0.0, worth = 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const double weight = 1.0 / variance_of(blocks_[b]);
    for (Eigen::Index i = 0; i < free; ++i) {
      const Eigen::VectorXd noisy = times_noise(blocks_[b].autocovariance_m2, projected_[b].col(i));
      middle.col(i) += weight * weight * transposed_product(projected_[b], noisy);
    }
    chi2 += weight * at_[b].residual.squaredNorm();
    const auto points = static_cast<double>(at_[b].residual.size());
    count += points;
    worth += independent(blocks_[b], points);
  }
  fit.covariance = product(product(inverse_, middle), inverse_);
  fit.degrees = std::numeric_limits<double>::infinity();
  const double freedom = std::max(1.0, count - static_cast<double>(free) - 2.0 * static_cast<double>(blocks_.size()));
  const double ratio = chi2 / freedom;
  fit.scatter = std::sqrt(ratio);
  fit.points = static_cast<std::size_t>(count);
  if (ratio > core::chi2_ratio_limit(worth)) add_misfit(count, ratio, fit);
  compare_with_jackknife(fit);
  add_shared(fit);
}

/// The scores of pieces of the motion, so long that they are as good as independent.
void TrajectoryUncertainty::add_misfit(double count, double ratio, TrajectoryFit& fit) const {
  const auto length = static_cast<Eigen::Index>(std::max(1.0, std::ceil(count / static_cast<double>(kFewestPieces))));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(inverse_.rows(), inverse_.rows());
  double pieces = 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Eigen::VectorXd& residual = at_[b].residual;
    for (Eigen::Index from = 0; from < residual.size(); from += length) {
      const Eigen::Index n = std::min(length, residual.size() - from);
      const Eigen::VectorXd score =
          transposed_product(projected_[b].middleRows(from, n), residual.segment(from, n)) / variance_of(blocks_[b]);
      sum += product(score, score.transpose());
      pieces += 1.0;
    }
  }
  // The parameters that were fitted take their share out of the scores.
  const double freedom = std::max(1.0, pieces - static_cast<double>(inverse_.rows()));
  const Eigen::MatrixXd wider = product(product(inverse_, sum), inverse_) * ((1.0 - 1.0 / ratio) * pieces / freedom);
  // Not below what white residuals of that size would give.
  Eigen::VectorXd growth(inverse_.rows());
  for (Eigen::Index i = 0; i < growth.size(); ++i) {
    growth[i] = std::max(1.0, std::sqrt((ratio - 1.0) * inverse_(i, i) / std::max(wider(i, i), 1e-300)));
  }
  fit.covariance += growth.asDiagonal() * wider * growth.asDiagonal();
  fit.degrees = freedom;
}

/// One block left out at a time.
void TrajectoryUncertainty::compare_with_jackknife(TrajectoryFit& fit) const {
  if (blocks_.size() < kFewestBlocks) return;
  const Eigen::Index free = inverse_.rows();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(free, free);
  const auto n = static_cast<double>(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const double weight = 1.0 / variance_of(blocks_[b]);
    const Eigen::MatrixXd rest = normal_ - weight * transposed_product(projected_[b], projected_[b]);
    const Eigen::VectorXd scale = normal_.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * rest * scale.asDiagonal();
    if (!(base::symmetric_eigen(scaled).values[0] > kCondition)) return;  // one block holds the fit alone
    const Eigen::VectorXd score = weight * transposed_product(projected_[b], at_[b].residual);
    const Eigen::VectorXd moved = base::solve_positive(rest, score);
    covariance += ((n - 1.0) / n) * product(moved, moved.transpose());
  }
  const double limit = core::chi2_ratio_limit(n - 1.0);
  bool larger = false;
  for (Eigen::Index i = 0; i < free; ++i) larger = larger || covariance(i, i) > limit * fit.covariance(i, i);
  if (!larger) return;
  // No parameter gets less than the noise gives it.
  Eigen::VectorXd growth(free);
  for (Eigen::Index i = 0; i < free; ++i) {
    growth[i] = std::sqrt(std::max(1.0, fit.covariance(i, i) / std::max(covariance(i, i), 1e-300)));
  }
  fit.covariance = growth.asDiagonal() * covariance * growth.asDiagonal();
  fit.degrees = n - 1.0;
}

void TrajectoryUncertainty::add_shared(TrajectoryFit& fit) const {
  std::size_t modes = 0;
  for (const FitBlock& block : blocks_) modes = std::max(modes, block.block->shared_m.size());
  fit.shared.assign(modes + 1, Eigen::VectorXd::Zero(inverse_.rows()));
  Eigen::VectorXd clock = 2.0 * core::kClockSdRelative * fit.parameters;  // accelerations go as 1 / time^2
  clock[0] *= 0.5;
  fit.shared.push_back(clock);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const core::FreeBlock& block = *blocks_[b].block;
    const Eigen::MatrixXd gain = product(inverse_, projected_[b].transpose()) / variance_of(blocks_[b]);
    for (std::size_t mode = 0; mode < block.shared_m.size(); ++mode) {
      if (block.shared_m[mode].empty()) continue;
      fit.shared[mode] += product(gain, Eigen::Map<const Eigen::VectorXd>(block.shared_m[mode].data(), gain.cols()));
    }
    fit.shared[modes] +=
        blocks_[b].scale_sd_relative * product(gain, Eigen::Map<const Eigen::VectorXd>(block.x_m.data(), gain.cols()));
  }
}

}  // namespace glidelab::fit
