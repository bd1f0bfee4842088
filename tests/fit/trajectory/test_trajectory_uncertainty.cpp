/// TrajectoryUncertainty on made-up linear problems, in which dense matrices and refits of all data say what is right.
#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"
#include "fit/trajectory/trajectory_fit.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

const std::vector<double> kNoise{4.0, 1.5, 0.5};  // m² at lags of 0, 1 and 2 points

/// Blocks of 24 points or so, each with one more than the one before: x = common p + start s + noise, with random
/// derivatives.
struct Made {
  int free;
  std::vector<core::FreeBlock> blocks;
  std::vector<fit::FitBlock> fits;
  std::vector<fit::Linearised> at;

  Made(int count, int free_parameters, unsigned seed, Eigen::Index shortest = 24)
      : free(free_parameters), blocks(static_cast<std::size_t>(count)) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (int b = 0; b < count; ++b) {
      const Eigen::Index n = shortest + b;
      core::FreeBlock& block = blocks[static_cast<std::size_t>(b)];
      fit::Linearised of{Eigen::VectorXd(n), Eigen::MatrixXd(n, 3), Eigen::MatrixXd(n, 2), {}};
      block.shared_m.resize(b == 1 ? 1 : 2);
      if (b == 2) block.shared_m[0].clear();
      for (Eigen::Index i = 0; i < n; ++i) {
        block.t_s.push_back(static_cast<double>(i));
        block.x_m.push_back(normal(random));
        for (std::size_t mode = b == 2 ? 1 : 0; mode < block.shared_m.size(); ++mode) {
          block.shared_m[mode].push_back(normal(random));
        }
        of.residual[i] = normal(random);
        for (int c = 0; c < 3; ++c) of.common(i, c) = normal(random) + std::cos(0.1 * static_cast<double>(i * (c + 1)));
        of.start.row(i) << 1.0, 0.3 * static_cast<double>(i) + normal(random);
      }
      if (b != 1) {
        of.force = Eigen::VectorXd(n);
        for (Eigen::Index i = 0; i < n; ++i) of.force[i] = normal(random);
        block.force.mass_sd_relative = 0.01 * (b + 1);
      }
      at.push_back(std::move(of));
      const double scale = 1.0 + 0.5 * b;  // each block has a noise of its own
      fits.push_back({&block, {kNoise[0] * scale, kNoise[1] * scale, kNoise[2] * scale}, 0.001 * (b + 1)});
    }
  }

  Eigen::Index blocks_count() const { return static_cast<Eigen::Index>(blocks.size()); }
  Eigen::Index points() const {
    Eigen::Index sum = 0;
    for (const fit::Linearised& of : at) sum += of.residual.size();
    return sum;
  }
  static Eigen::Index from_of(const Made& made, Eigen::Index block) {
    Eigen::Index from = 0;
    for (Eigen::Index b = 0; b < block; ++b) from += made.at[static_cast<std::size_t>(b)].residual.size();
    return from;
  }

  /// All derivatives, of every block by the common parameters and by its own start.
  Eigen::MatrixXd design() const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(points(), free + 2 * blocks_count());
    for (Eigen::Index b = 0; b < blocks_count(); ++b) {
      const fit::Linearised& of = at[static_cast<std::size_t>(b)];
      all.block(from_of(*this, b), 0, of.residual.size(), free) = of.common.leftCols(free);
      all.block(from_of(*this, b), free + 2 * b, of.residual.size(), 2) = of.start;
    }
    return all;
  }
  /// The noise's covariance, and the weights 1 / variance.
  Eigen::MatrixXd gamma() const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(points(), points());
    for (Eigen::Index b = 0; b < blocks_count(); ++b) {
      const std::vector<double>& of = fits[static_cast<std::size_t>(b)].autocovariance_m2;
      const Eigen::Index from = from_of(*this, b), n = at[static_cast<std::size_t>(b)].residual.size();
      for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = 0; j < n; ++j) {
          const auto lag = static_cast<std::size_t>(std::abs(i - j));
          if (lag < of.size()) all(from + i, from + j) = of[lag];
        }
      }
    }
    return all;
  }
  Eigen::VectorXd weights() const { return gamma().diagonal().cwiseInverse(); }
  Eigen::VectorXd residuals() const {
    Eigen::VectorXd all(points());
    for (Eigen::Index b = 0; b < blocks_count(); ++b) {
      const Eigen::VectorXd& of = at[static_cast<std::size_t>(b)].residual;
      all.segment(from_of(*this, b), of.size()) = of;
    }
    return all;
  }
  void set_residuals(const Eigen::VectorXd& all) {
    for (Eigen::Index b = 0; b < blocks_count(); ++b) {
      Eigen::VectorXd& of = at[static_cast<std::size_t>(b)].residual;
      of = Eigen::VectorXd(all.segment(from_of(*this, b), of.size()));
    }
  }
  /// How all parameters answer to changes of the positions, as rows.
  Eigen::MatrixXd gain() const {
    const Eigen::MatrixXd d = design();
    const Eigen::MatrixXd weighted = weights().asDiagonal() * d;
    return (d.transpose() * weighted).ldlt().solve(weighted.transpose());
  }
  /// As they are at the minimum.
  void settle() { set_residuals(residuals() - design() * (gain() * residuals())); }
  double chi2() const { return residuals().cwiseAbs2().dot(weights()); }
  double freedom() const { return static_cast<double>(points() - free - 2 * blocks_count()); }
  /// Residuals of this chi² per degree of freedom.
  void set_ratio(double ratio) { set_residuals(residuals() * std::sqrt(ratio * freedom() / chi2())); }

  fit::TrajectoryFit filled() const {
    fit::TrajectoryFit fit;
    fit.parameters = Eigen::Vector3d(2.0, 0.7, 0.05).head(free);
    const fit::TrajectoryUncertainty uncertainty(fits, at, free);
    REQUIRE(uncertainty.determined());
    uncertainty.fill(fit);
    return fit;
  }

  /// L Gamma L'
  Eigen::MatrixXd of_noise() const {
    const Eigen::MatrixXd g = gain().topRows(free);
    return g * gamma() * g.transpose();
  }
  /// (J' W J)^-1 of the common parameters: the covariance of white noise.
  Eigen::MatrixXd of_white() const {
    const Eigen::MatrixXd d = design();
    return (d.transpose() * weights().asDiagonal() * d).inverse().topLeftCorner(free, free);
  }

  /// What the pieces' scores add, as the head of trajectory_fit.h says, and its degrees of freedom.
  std::pair<Eigen::MatrixXd, double> of_misfit() const {
    const double ratio = chi2() / freedom();
    const auto length = static_cast<Eigen::Index>(std::ceil(static_cast<double>(points()) / 8.0));
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(free, free);
    const Eigen::MatrixXd g = gain().topRows(free);
    double pieces = 0.0;
    for (Eigen::Index b = 0; b < blocks_count(); ++b) {
      const Eigen::Index first = from_of(*this, b), end = first + at[static_cast<std::size_t>(b)].residual.size();
      for (Eigen::Index from = first; from < end; from += length, pieces += 1.0) {
        const Eigen::Index n = std::min(length, end - from);
        const Eigen::VectorXd moved = g.middleCols(from, n) * residuals().segment(from, n);
        sum += moved * moved.transpose();
      }
    }
    const double degrees = pieces - free;
    sum *= (1.0 - 1.0 / ratio) * pieces / degrees;
    const Eigen::VectorXd least = (ratio - 1.0) * of_white().diagonal();
    const Eigen::VectorXd factor = least.cwiseQuotient(sum.diagonal()).cwiseMax(1.0).cwiseSqrt();
    return {factor.asDiagonal() * sum * factor.asDiagonal(), degrees};
  }

  /// All data refitted without one block after another.
  Eigen::MatrixXd of_refits() const {
    const auto n = static_cast<double>(blocks.size());
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(free, free);
    for (Eigen::Index left_out = 0; left_out < blocks_count(); ++left_out) {
      Eigen::VectorXd root = weights().cwiseSqrt();
      root.segment(from_of(*this, left_out), at[static_cast<std::size_t>(left_out)].residual.size()).setZero();
      const Eigen::MatrixXd d = root.asDiagonal() * design();
      // Of the block's own start, which nothing determines, the least: 0.
      const Eigen::VectorXd moved =
          d.completeOrthogonalDecomposition().solve(Eigen::VectorXd(root.cwiseProduct(residuals())));
      sum += (n - 1.0) / n * moved.head(free) * moved.head(free).transpose();
    }
    return sum;
  }
  /// How many independent residuals the fit leaves.
  double worth() const {
    double sum = 0.0;
    for (const fit::Linearised& of : at) {
      const double r1 = kNoise[1] / kNoise[0], r2 = kNoise[2] / kNoise[0];
      sum += static_cast<double>(of.residual.size()) / (1.0 + 2.0 * r1 * r1 + 2.0 * r2 * r2);
    }
    return sum * freedom() / static_cast<double>(points());
  }
};

/// To rounding, of matrices of a condition below 1e4.
void check_same(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  INFO("found\n" << found << "\nexpected\n" << expected);
  REQUIRE(found.rows() == expected.rows());
  REQUIRE(found.cols() == expected.cols());
  CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-9 * expected.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("the covariance of a fit of whole motions is that of dense matrices, for correlated noise of each clip") {
  for (const int free : {2, 3}) {
    for (const int blocks : {1, 3, 5}) {
      INFO(free << " parameters, " << blocks << " blocks");
      Made made(blocks, free, 1);
      made.settle();
      made.set_ratio(1e-3);
      const fit::TrajectoryFit fit = made.filled();
      check_same(fit.covariance, made.of_noise());
      CHECK(std::isinf(fit.degrees));
      CHECK(fit.points == static_cast<std::size_t>(made.points()));
      CHECK(fit.scatter == Approx(std::sqrt(1e-3)).epsilon(1e-9));
    }
  }
}

TEST_CASE("errors that all positions share move the parameters as least squares of all data moves them") {
  Made made(3, 3, 2);
  made.settle();
  made.set_ratio(1.0);
  const fit::TrajectoryFit fit = made.filled();
  const Eigen::MatrixXd gain = made.gain().topRows(3);
  Eigen::MatrixXd shifts = Eigen::MatrixXd::Zero(made.points(), 5);  // two modes, scale, clock, mass
  for (Eigen::Index b = 0; b < 3; ++b) {
    const auto i = static_cast<std::size_t>(b);
    const core::FreeBlock& block = made.blocks[i];
    const auto vector = [](const std::vector<double>& of) {
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(of.data(), static_cast<Eigen::Index>(of.size())));
    };
    const Eigen::Index from = Made::from_of(made, b), n = made.at[i].residual.size();
    for (std::size_t mode = 0; mode < block.shared_m.size(); ++mode) {
      if (block.shared_m[mode].empty()) continue;
      shifts.col(static_cast<Eigen::Index>(mode)).segment(from, n) = vector(block.shared_m[mode]);
    }
    shifts.col(2).segment(from, n) = made.fits[i].scale_sd_relative * vector(block.x_m);
    if (made.at[i].force.size() == 0) continue;
    shifts.col(3).segment(from, n) = 2.0 * core::kClockSdRelative * made.at[i].force;
    shifts.col(4).segment(from, n) = block.force.mass_sd_relative * made.at[i].force;
  }
  Eigen::MatrixXd expected = gain * shifts;
  // A slow clock: K/m scales as 1 / time, accelerations as 1 / time².
  expected.col(3) +=
      core::kClockSdRelative * Eigen::Vector3d(fit.parameters[0], 2.0 * fit.parameters[1], 2.0 * fit.parameters[2]);
  REQUIRE(fit.shared.size() == 5);
  for (Eigen::Index c = 0; c < 5; ++c) {
    INFO("error " << c);
    check_same(fit.shared[static_cast<std::size_t>(c)], expected.col(c));
  }
}

TEST_CASE("residuals beyond chance widen the covariance by the scores of pieces, and those within it do not") {
  for (const int blocks : {1, 3}) {
    Made made(blocks, 3, 3);
    made.settle();
    const double limit = core::chi2_ratio_limit(made.worth());
    made.set_ratio(0.999 * limit);
    check_same(made.filled().covariance, made.of_noise());
    CHECK(std::isinf(made.filled().degrees));
    for (const double ratio : {1.001 * limit, 25.0}) {
      INFO(blocks << " blocks, ratio " << ratio);
      made.set_ratio(ratio);
      const fit::TrajectoryFit fit = made.filled();
      const auto [wider, degrees] = made.of_misfit();
      check_same(fit.covariance, made.of_noise() + wider);
      CHECK(fit.degrees == degrees);
      CHECK(fit.scatters);
      CHECK_FALSE(fit.by_jackknife);
      CHECK(fit.scatter == Approx(std::sqrt(ratio)).epsilon(1e-9));
    }
  }
}

TEST_CASE("blocks that disagree widen the covariance to that of refits without one block after another") {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 3.0);
  // Parameters that differ from block to block by more than the noise makes them.
  const auto disagreeing = [&](int blocks) {
    Made made(blocks, 3, 5);
    for (fit::Linearised& of : made.at) {
      of.residual = of.common * Eigen::Vector3d(normal(random), normal(random), normal(random));
    }
    made.settle();
    return made;
  };
  bool kept = false;  // one parameter at what the noise gives, while another's variance grows
  for (const int blocks : {4, 9}) {
    INFO(blocks << " blocks");
    Made made = disagreeing(blocks);
    made.set_ratio(1.0);
    const Eigen::MatrixXd noise = made.of_noise();
    const double limit = core::chi2_ratio_limit(blocks - 1.0);
    const double most = made.of_refits().diagonal().cwiseQuotient(noise.diagonal()).maxCoeff();
    made.set_ratio(0.999 * limit / most);
    check_same(made.filled().covariance, noise);
    CHECK(std::isinf(made.filled().degrees));
    made.set_ratio(1.001 * limit / most);
    REQUIRE(made.chi2() / made.freedom() < core::chi2_ratio_limit(made.worth()));  // their size alone is no misfit
    const fit::TrajectoryFit fit = made.filled();
    CHECK(fit.degrees == blocks - 1.0);
    CHECK(fit.by_jackknife);
    CHECK_FALSE(fit.scatters);
    const Eigen::MatrixXd larger = made.of_refits();
    const Eigen::VectorXd factor = noise.diagonal().cwiseQuotient(larger.diagonal()).cwiseMax(1.0).cwiseSqrt();
    check_same(fit.covariance, factor.asDiagonal() * larger * factor.asDiagonal());
    kept = kept || factor.maxCoeff() > 1.0;
  }
  CHECK(kept);
  // Of three none is left out, however much they disagree.
  Made few = disagreeing(3);
  few.set_ratio(1e4);
  const auto [wider, degrees] = few.of_misfit();
  check_same(few.filled().covariance, few.of_noise() + wider);
  CHECK(few.filled().degrees == degrees);
}

TEST_CASE(
    "of blocks that differ and move one way, what each leaves with its own parameters is judged by the right number") {
  // Friction acts on a block that moves one way as the drive does, but for the sign: a block has x0, v0, the drag and
  // one of these, four parameters, while the fit of all has both. One block alone moves the other way, and cannot be
  // left out.
  constexpr int kBlocks = 12;
  const auto made_with = [](double own_ratio) {
    Made made(kBlocks, 3, 6, 8);
    std::mt19937_64 random(8);
    std::normal_distribution<double> normal;
    double chi2 = 0.0, freedom = 0.0;
    std::vector<Eigen::VectorXd> own;
    for (std::size_t b = 0; b < kBlocks; ++b) {
      fit::Linearised& of = made.at[b];
      made.fits[b].autocovariance_m2 = {kNoise[0] * (1.0 + 0.5 * static_cast<double>(b)), 0.0, 0.0};
      of.common.col(2) = (b == 0 ? 1.0 : -1.0) * of.common.col(1);
      Eigen::MatrixXd design(of.residual.size(), 4);
      design << of.common.leftCols(2), of.start;
      own.emplace_back(of.residual - design * design.colPivHouseholderQr().solve(of.residual));
      chi2 += own.back().squaredNorm() / fit::variance_of(made.fits[b]);
      freedom += static_cast<double>(of.residual.size() - 4);
    }
    for (std::size_t b = 0; b < kBlocks; ++b) {
      made.at[b].residual = own[b] * std::sqrt(own_ratio * freedom / chi2) +
                            made.at[b].common * Eigen::Vector3d(normal(random), 20.0 * normal(random), 0.0);
    }
    made.settle();
    return made;
  };
  double freedom = 0.0;
  for (int b = 0; b < kBlocks; ++b) freedom += 8 + b - 4;
  const double limit = core::chi2_ratio_limit(freedom);
  const Made within = made_with(0.999 * limit), beyond = made_with(1.001 * limit);
  REQUIRE(within.chi2() / within.freedom() > core::chi2_ratio_limit(within.freedom()));  // the blocks do differ
  const fit::TrajectoryFit fit = within.filled();
  check_same(fit.covariance, within.of_noise());
  CHECK(std::isinf(fit.degrees));
  CHECK(fit.scatters);
  CHECK_FALSE(fit.by_jackknife);
  CHECK(std::isfinite(beyond.filled().degrees));
}
