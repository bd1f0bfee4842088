#include "fit/trajectory/trajectory_fit.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.h"
#include "base/math/dense.h"
#include "base/math/levenberg_marquardt.h"
#include "core/math/quantile.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"
#include "sim/sensitivity/driven_track.h"

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

/// Effective number of independent points, from the noise's autocovariance.
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
    // The part of the derivatives that no start x0, v0 can absorb.
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
  double count = 0.0, worth = 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const double weight = 1.0 / variance_of(blocks_[b]);
    for (Eigen::Index i = 0; i < free; ++i) {
      const Eigen::VectorXd noisy = times_noise(blocks_[b].autocovariance_m2, projected_[b].col(i));
      middle.col(i) += weight * weight * transposed_product(projected_[b], noisy);
    }
    // A position that a robust fit leaves out has the weight 0, and so no derivative.
    const auto points = static_cast<double>((at_[b].start.rowwise().squaredNorm().array() > 0.0).count());
    count += points;
    worth += independent(blocks_[b], points);
  }
  fit.covariance = product(product(inverse_, middle), inverse_);
  fit.degrees = std::numeric_limits<double>::infinity();
  const auto blocks = static_cast<double>(blocks_.size());
  const auto ratio_of = [&](const Rest& rest) {
    double chi2 = 0.0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) chi2 += rest.of_block[b].squaredNorm() / variance_of(blocks_[b]);
    return chi2 / std::max(1.0, count - rest.parameters);
  };
  const auto exceeds = [&](double ratio, const Rest& rest) {
    return ratio > core::chi2_ratio_limit(worth * (1.0 - rest.parameters / count));
  };
  Rest rest{{}, static_cast<double>(free) + 2.0 * blocks};
  for (const Linearised& of : at_) rest.of_block.push_back(of.residual);
  double ratio = ratio_of(rest);
  fit.scatter = std::sqrt(ratio);
  fit.points = static_cast<std::size_t>(count);
  fit.scatters = exceeds(ratio, rest);
  if (fit.scatters && blocks_.size() >= kFewestBlocks) {
    rest = with_parameters_of_their_own(std::move(rest));
    ratio = ratio_of(rest);
  }
  if (exceeds(ratio, rest)) add_misfit(rest.of_block, count, ratio, fit);
  compare_with_jackknife(fit);
  add_shared(fit);
}

/// What is left with parameters of each block's own. A block that has another K/m shows it all along: the scores of its
/// pieces are larger than that of the block as a whole, and of opposite signs. A block that moves one way determines
/// one parameter fewer, since drive and friction change its positions alike.
TrajectoryUncertainty::Rest TrajectoryUncertainty::with_parameters_of_their_own(Rest rest) const {
  constexpr double kAlike = 1e-6;  // of the columns' lengths: far above rounding, far below what any position shows
  rest.parameters = 2.0 * static_cast<double>(rest.of_block.size());
  for (std::size_t b = 0; b < rest.of_block.size(); ++b) {
    const Eigen::VectorXd lengths = projected_[b].colwise().norm().cwiseMax(std::numeric_limits<double>::min());
    const Eigen::MatrixXd basis =
        base::orthonormal_columns(projected_[b] * lengths.cwiseInverse().asDiagonal(), kAlike);
    rest.of_block[b] -= product(basis, transposed_product(basis, rest.of_block[b]));
    rest.parameters += static_cast<double>(basis.cols());
  }
  return rest;
}

/// The scores of pieces of the motion that are long enough to be practically independent.
void TrajectoryUncertainty::add_misfit(const std::vector<Eigen::VectorXd>& residuals, double count, double ratio,
                                       TrajectoryFit& fit) const {
  const auto length = static_cast<Eigen::Index>(std::max(1.0, std::ceil(count / static_cast<double>(kFewestPieces))));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(inverse_.rows(), inverse_.rows());
  double pieces = 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Eigen::VectorXd& residual = residuals[b];
    for (Eigen::Index from = 0; from < residual.size(); from += length) {
      const Eigen::Index n = std::min(length, residual.size() - from);
      const Eigen::VectorXd score =
          transposed_product(projected_[b].middleRows(from, n), residual.segment(from, n)) / variance_of(blocks_[b]);
      sum += product(score, score.transpose());
      pieces += 1.0;
    }
  }
  // The fitted parameters reduce the scores by their share.
  const double freedom = std::max(1.0, pieces - static_cast<double>(inverse_.rows()));
  const Eigen::MatrixXd wider = product(product(inverse_, sum), inverse_) * ((1.0 - 1.0 / ratio) * pieces / freedom);
  // Not below the value for white residuals of that size.
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
    if (!(base::symmetric_eigen(scaled).values[0] > kCondition)) return;  // one block alone determines the fit
    const Eigen::VectorXd score = weight * transposed_product(projected_[b], at_[b].residual);
    const Eigen::VectorXd moved = base::solve_positive(rest, score);
    covariance += ((n - 1.0) / n) * product(moved, moved.transpose());
  }
  const double limit = core::chi2_ratio_limit(n - 1.0);
  bool larger = false;
  for (Eigen::Index i = 0; i < free; ++i) larger = larger || covariance(i, i) > limit * fit.covariance(i, i);
  if (!larger) return;
  // No parameter gets a variance below that from the noise.
  Eigen::VectorXd growth(free);
  for (Eigen::Index i = 0; i < free; ++i) {
    growth[i] = std::sqrt(std::max(1.0, fit.covariance(i, i) / std::max(covariance(i, i), 1e-300)));
  }
  fit.covariance = growth.asDiagonal() * covariance * growth.asDiagonal();
  fit.degrees = n - 1.0;
  fit.by_jackknife = true;
}

void TrajectoryUncertainty::add_shared(TrajectoryFit& fit) const {
  std::size_t modes = 0;
  for (const FitBlock& block : blocks_) modes = std::max(modes, block.block->shared_m.size());
  fit.shared.assign(modes + 1, Eigen::VectorXd::Zero(inverse_.rows()));
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(inverse_.rows());
  Eigen::VectorXd clock = 2.0 * core::kClockSdRelative * fit.parameters;  // accelerations scale as 1 / time^2
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
    if (at_[b].force.size() == 0) continue;
    const Eigen::VectorXd by_force = product(gain, at_[b].force);
    mass += block.force.mass_sd_relative * by_force;
    fit.shared[modes + 1] += 2.0 * core::kClockSdRelative * by_force;  // a slow clock also makes the force too small
  }
  if (mass.squaredNorm() > 0.0) fit.shared.push_back(mass);
}

namespace {

using base::product;
using base::transposed_product;

constexpr int kMostIterations = 60;
constexpr double kConverged = 1e-10;  // relative change of the cost
constexpr int kRobustPasses = 8;
constexpr double kHuber = 1.5;    // scaled deviations beyond which a position is weighted down
constexpr double kOutlier = 4.0;  // and beyond which it is left out: 6 of 1e5 by chance

/// The recorded force of a block as a drive from its first point on, multiplied by `factor`.
sim::RecordedDrive drive_of(const core::FreeBlock& block, double factor) {
  sim::RecordedDrive drive;
  for (std::size_t i = 0; i < block.force.t_s.size(); ++i) {
    drive.t_s.push_back(block.force.t_s[i] - block.t_s.front());
    drive.p_m_s2.push_back(factor * block.force.a_m_s2[i]);
  }
  return drive;
}

constexpr double kForceStep = 1e-4;  // relative step of the force, for the numerical derivative of the motion

Linearised linearise(const FitBlock& fit, const Eigen::Vector3d& common, const Eigen::Vector2d& start) {
  const core::FreeBlock& block = *fit.block;
  std::vector<double> times;
  for (const double t : block.t_s) times.push_back(t - block.t_s.front());
  const auto moved = [&](double factor) {
    return sim::driven_track_sensitive(common[0], common[1], common[2], start[0], start[1], times,
                                       drive_of(block, factor));
  };
  const std::vector<sim::SensitiveState> states = moved(1.0);
  const auto n = static_cast<Eigen::Index>(times.size());
  Linearised result{Eigen::VectorXd(n), Eigen::MatrixXd(n, 3), Eigen::MatrixXd(n, 2), {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const sim::SensitiveState& state = states[static_cast<std::size_t>(i)];
    result.residual[i] = block.x_m[static_cast<std::size_t>(i)] - state.x_m;
    result.common.row(i) = state.by_parameter.row(0).head(3);
    result.start.row(i) = state.by_parameter.row(0).tail(2);
  }
  if (!block.force.empty()) {
    const auto above = moved(1.0 + kForceStep), below = moved(1.0 - kForceStep);
    result.force.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto p = static_cast<std::size_t>(i);
      result.force[i] = (above[p].x_m - below[p].x_m) / (2.0 * kForceStep);
    }
  }
  return result;
}

struct Point {
  Eigen::Vector3d common;
  std::vector<Eigen::Vector2d> starts;
};

/// A point, the weighted linearisation there, and its cost.
struct Evaluated {
  Point at;
  std::vector<Linearised> linearised;
  double cost = std::numeric_limits<double>::infinity();
};

class Problem {
 public:
  /// `weights` of every position of every block; empty: 1.
  Problem(const std::vector<FitBlock>& blocks, std::vector<Eigen::VectorXd> weights, int free)
      : blocks_(blocks), free_(free) {
    for (const Eigen::VectorXd& of_block : weights) roots_.push_back(of_block.cwiseSqrt());
  }

  /// The cost is infinite if the motion cannot be integrated.
  Evaluated evaluate(Point point) const {
    Evaluated there{std::move(point), {}};
    double cost = 0.0;
    try {
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        there.linearised.push_back(linearise(blocks_[b], there.at.common, there.at.starts[b]));
        if (!roots_.empty()) there.linearised.back().scale_rows(roots_[b]);
        cost += there.linearised.back().residual.squaredNorm() / variance_of(blocks_[b]);
      }
    } catch (const base::NumericalError&) {
      return there;
    }
    if (std::isfinite(cost)) there.cost = cost;
    return there;
  }

  /// The Levenberg-Marquardt step, with each block's start eliminated.
  Point step(const Evaluated& from, double damping) const {
    const std::vector<Linearised>& linearised = from.linearised;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(free_, free_);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(free_);
    Eigen::VectorXd diagonal = right;
    std::vector<Eigen::Matrix2d> own;
    std::vector<Eigen::MatrixXd> cross;
    std::vector<Eigen::Vector2d> own_right;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const double weight = 1.0 / variance_of(blocks_[b]);
      const auto common = linearised[b].common.leftCols(free_);
      const Eigen::MatrixXd& start = linearised[b].start;
      Eigen::Matrix2d c = weight * transposed_product(start, start);
      c.diagonal() *= 1.0 + damping;
      const Eigen::MatrixXd x = weight * transposed_product(common, start);
      const Eigen::Vector2d r = weight * transposed_product(start, linearised[b].residual);
      const Eigen::MatrixXd a = weight * transposed_product(common, common);
      diagonal += a.diagonal();
      const Eigen::Matrix2d inverse = c.inverse();
      const Eigen::MatrixXd taken = product(x, inverse);
      normal += a - product(taken, x.transpose());
      right += weight * transposed_product(common, linearised[b].residual) - product(taken, r);
      own.push_back(inverse);
      cross.push_back(x);
      own_right.push_back(r);
    }
    normal.diagonal() += damping * diagonal;
    const Eigen::VectorXd change = base::solve_positive(normal, right);
    Point next = from.at;
    next.common.head(free_) += change;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      next.starts[b] += own[b] * (own_right[b] - Eigen::Vector2d(transposed_product(cross[b], change)));
    }
    return next;
  }

 private:
  const std::vector<FitBlock>& blocks_;
  int free_;
  std::vector<Eigen::VectorXd> roots_;
};

/// x0 and v0 of a parabola through the first points, or of a line through fewer.
Eigen::Vector2d start_of(const core::FreeBlock& block) {
  const auto n = static_cast<Eigen::Index>(std::min<std::size_t>(block.t_s.size(), 15));
  Eigen::MatrixXd design(n, 3);
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = block.t_s[static_cast<std::size_t>(i)] - block.t_s.front();
    design.row(i) << 1.0, t, t * t;
    x[i] = block.x_m[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector3d fit = base::least_squares(design, x);
  // A block that moves in one direction starts in that direction, whatever the noise.
  const double least = 1e-6;
  const double v = block.directions.front() * std::max(least, block.directions.front() * fit[1]);
  return {fit[0], v};
}

struct Found : Evaluated {
  bool converged = false;
  int iterations = 0;
};

Found minimise(const Problem& problem, Point at) {
  base::FitOptions options;
  options.most_iterations = kMostIterations;
  options.damping_start = 1e-4;
  options.damping_least = 1e-12;
  options.cost_relative = kConverged;
  const auto try_step = [&](const Evaluated& here, double damping) {
    base::FitTrial<Evaluated> trial;
    trial.point = problem.evaluate(problem.step(here, damping));
    trial.cost = trial.point->cost;
    return trial;
  };
  Evaluated here = problem.evaluate(std::move(at));
  const double start_cost = here.cost;
  const base::FitSummary summary = base::levenberg_marquardt(here, start_cost, options, try_step);
  // If no step lowers the cost any more, only rounding is left.
  const bool converged = base::is_settled(summary.stop) || summary.stop == base::FitStop::no_descent;
  return {std::move(here), converged, summary.iterations};
}

/// The only direction that occurs, or 0 for both.
int only_direction(const std::vector<FitBlock>& blocks) {
  int only = 0;
  for (const FitBlock& block : blocks) {
    for (const int direction : block.block->directions) {
      if (only != 0 && direction != only) return 0;
      only = direction;
    }
  }
  return only;
}

/// The best of several starts: the cost is not convex where the motion turns.
Found minimise_from_several(const Problem& problem, const Point& first) {
  Found best;
  for (const double share : {1.0, 0.3, 2.0}) {
    Point at = first;
    at.common[0] *= share;
    Found found = minimise(problem, at);
    if (found.converged && (!best.converged || found.cost < best.cost)) best = std::move(found);
  }
  return best;
}

struct RobustFit {
  Found found;
  std::vector<FitBlock> blocks;  // with the noise of the positions that are not left out
  std::size_t left_out = 0;
};

/// Huber's weights until they settle, then without the positions that are off by more than kOutlier scaled deviations.
RobustFit fit_robustly(const std::vector<FitBlock>& blocks, int free, Found found) {
  RobustFit fit{std::move(found), blocks, 0};
  for (int pass = 0; pass < kRobustPasses; ++pass) {
    const bool last = pass + 2 >= kRobustPasses;  // two passes with the remaining positions
    std::vector<Eigen::VectorXd> weights;
    fit.left_out = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const Eigen::VectorXd off = linearise(blocks[b], fit.found.at.common, fit.found.at.starts[b]).residual.cwiseAbs();
      const double middle = core::median_of({off.begin(), off.end()});
      const double scale = std::max(core::kSdOverMedian * middle, std::sqrt(kLeastVariance));
      const double shrink = std::min(1.0, scale * scale / variance_of(blocks[b]));
      fit.blocks[b] = blocks[b];
      for (double& gamma : fit.blocks[b].autocovariance_m2) gamma *= shrink;
      weights.emplace_back(off.size());
      for (Eigen::Index i = 0; i < off.size(); ++i) {
        const double deviations = off[i] / scale;
        weights.back()[i] = last ? (deviations > kOutlier ? 0.0 : 1.0) : std::min(1.0, kHuber / deviations);
        fit.left_out += weights.back()[i] == 0.0;
      }
    }
    const Problem problem(fit.blocks, std::move(weights), free);
    fit.found = minimise(problem, fit.found.at);
    if (!fit.found.converged) break;
  }
  return fit;
}

}  // namespace

std::optional<TrajectoryFit> fit_trajectories(const std::vector<FitBlock>& blocks, const Eigen::Vector3d& start,
                                              const TrajectoryOptions& options) {
  if (blocks.empty()) return {};
  const int direction = only_direction(blocks);
  const int free = direction == 0 ? 3 : 2;
  Point first{start, {}};
  if (direction != 0) first.common = {start[0], start[1] - direction * start[2], 0.0};
  for (const FitBlock& block : blocks) first.starts.push_back(start_of(*block.block));
  RobustFit best{minimise_from_several(Problem(blocks, {}, free), first), blocks, 0};
  if (!best.found.converged) return {};
  if (options.robust) best = fit_robustly(blocks, free, std::move(best.found));
  if (!best.found.converged) return {};
  const TrajectoryUncertainty uncertainty(best.blocks, best.found.linearised, free);
  if (!uncertainty.determined()) return {};
  TrajectoryFit fit;
  fit.parameters = best.found.at.common.head(free);
  fit.direction = direction;
  fit.starts = best.found.at.starts;
  fit.iterations = best.found.iterations;
  fit.left_out = best.left_out;
  uncertainty.fill(fit);
  return fit;
}

}  // namespace glidelab::fit
