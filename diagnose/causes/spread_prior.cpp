#include "diagnose/causes/spread_prior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>
#include "base/math/dense.h"
#include "base/math/log_sum.h"

namespace glidelab::diagnose {

namespace {

constexpr int kWidthsTried = 13;        // three per decade, over four decades
constexpr double kLeastWidth_sd = 2.0;  // standard deviations: a smaller width cannot be told from none
constexpr double kRoundingOfSum = 1e-13;
constexpr int kRoundsOfWidths = 4;

class Density {
 public:
  Density(const Eigen::VectorXd& sizes, const Eigen::MatrixXd& covariance, const std::vector<std::size_t>& kinds,
          const SharedPart* shared)
      : sizes_(sizes), covariance_(covariance), kinds_(kinds), shared_(shared) {}

  /// -log det(C + W)/2 - s' (C + W)⁻¹ s/2, evaluated with each size in units of its own standard deviation. The last
  /// width is that of the shared part, if there is one.
  double operator()(const std::vector<double>& widths) const {
    Eigen::MatrixXd sum = covariance_;
    if (shared_ != nullptr) sum += widths.back() * widths.back() * shared_->shape;
    Eigen::VectorXd unit(sizes_.size());
    for (Eigen::Index i = 0; i < sizes_.size(); ++i) {
      const double width = widths[kinds_[static_cast<std::size_t>(i)]];
      sum(i, i) += width * width;
      unit[i] = std::sqrt(sum(i, i));
    }
    const Eigen::VectorXd per = unit.cwiseInverse();
    Eigen::MatrixXd scaled = per.asDiagonal() * sum * per.asDiagonal();
    scaled.diagonal().array() += kRoundingOfSum;
    const Eigen::MatrixXd lower = base::cholesky_lower(scaled);
    const Eigen::VectorXd along = base::solve_lower(lower, sizes_.cwiseProduct(per));
    return -0.5 * along.squaredNorm() - lower.diagonal().array().log().sum() - unit.array().log().sum();
  }

 private:
  const Eigen::VectorXd& sizes_;
  const Eigen::MatrixXd& covariance_;
  const std::vector<std::size_t>& kinds_;
  const SharedPart* shared_;
};

/// Standard deviation of the best known combination of the sizes of one kind.
double least_sd(const Eigen::MatrixXd& covariance, const std::vector<std::size_t>& kinds, std::size_t kind) {
  std::vector<Eigen::Index> of;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] == kind) of.push_back(static_cast<Eigen::Index>(i));
  }
  const double least = base::symmetric_eigen(covariance(of, of)).values[0];
  // Rounding may wipe out the variance of a combination that is known far better than the others.
  const double largest = covariance.diagonal()(of).maxCoeff();
  return std::sqrt(std::max(least, kRoundingOfSum * largest));
}

}  // namespace

double log_spread_prior(const Eigen::VectorXd& sizes, const Eigen::MatrixXd& covariance,
                        const std::vector<std::size_t>& kinds, const SharedPart* shared) {
  const std::size_t own = kinds.empty() ? 0 : *std::max_element(kinds.begin(), kinds.end()) + 1;
  const std::size_t many = own + (shared != nullptr ? 1 : 0);
  const Density density(sizes, covariance, kinds, shared);
  std::vector<std::vector<double>> tried(many);
  std::vector<double> widths;
  for (std::size_t k = 0; k < many; ++k) {
    const double least = kLeastWidth_sd * least_sd(covariance, kinds, k < own ? k : shared->kind);
    for (int w = 0; w < kWidthsTried; ++w) tried[k].push_back(least * std::pow(10.0, w / 3.0));
    widths.push_back(tried[k].front());
  }
  // The best widths, one kind after the other; then the average over the widths of each.
  double best = -std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> logs(many);
  for (int round = 0; round < kRoundsOfWidths; ++round) {
    const double before = best;
    for (std::size_t k = 0; k < many; ++k) {
      std::vector<double> at = widths;
      logs[k].clear();
      for (const double width : tried[k]) {
        at[k] = width;
        logs[k].push_back(density(at));
        if (logs[k].back() <= best) continue;
        best = logs[k].back();
        widths[k] = width;
      }
    }
    if (!(best > before)) break;
  }
  double log = best;
  for (const std::vector<double>& of : logs) log += base::log_mean(of) - best;
  return log;
}

}  // namespace glidelab::diagnose
