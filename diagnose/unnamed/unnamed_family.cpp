#include "diagnose/unnamed/unnamed_family.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include "base/math/log_sum.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastPlace_sd = 2.0;  // standard deviations from which on a place is named
constexpr double kUnseen = 1e-10;       // relative to the largest square: anything smaller is absorbed by the fitted
                                        // parameters
constexpr double kMostSeen = 2e4;       // standard deviations of one bump: four decades from where it begins to show

/// Scalar products of columns with each other and with the residual.
struct Normal {
  Eigen::MatrixXd products;
  Eigen::VectorXd scores;
};

Eigen::MatrixXd rests_of(const std::vector<ScoreColumn>& columns) {
  Eigen::MatrixXd rests(columns.front().rest.size(), std::ssize(columns));
  for (std::size_t c = 0; c < columns.size(); ++c) rests.col(static_cast<Eigen::Index>(c)) = columns[c].rest;
  return rests;
}

Normal normal_of(const ScoreSpace& space, const std::vector<ScoreColumn>& columns) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Normal normal{Eigen::MatrixXd(n, n), Eigen::VectorXd(n)};
  for (Eigen::Index a = 0; a < n; ++a) {
    const auto& column = columns[static_cast<std::size_t>(a)];
    normal.scores[a] = space.dot(column, space.residual());
    for (Eigen::Index b = 0; b <= a; ++b) {
      normal.products(a, b) = normal.products(b, a) = space.dot(column, columns[static_cast<std::size_t>(b)]);
    }
  }
  return normal;
}

/// Variance of the residuals that are left after such a gain, over that of the noise: sizes cannot be known better than
/// that. Never below 1.
double left_of(const ScoreSpace& space, double gain) {
  const ScoreColumn& residual = space.residual();
  const auto points = static_cast<double>(residual.rest.size());
  return std::max(1.0, (space.dot(residual, residual) - 2.0 * gain) / points);
}

/// One bump alone, or one step (all bumps from some place on), wherever it explains most. The evidence is averaged over
/// the places, so that an effect at one place only is penalised once, and not for all the places where there is none.
UnnamedFamily one_place(const ScoreSpace& space, const Normal& normal, const std::vector<ScoreColumn>& columns,
                        const Grid& grid, bool step, UnnamedFamily family) {
  const Eigen::Index n = normal.scores.size();
  if (!normal.products.allFinite()) return family;
  const double largest = normal.products.diagonal().maxCoeff();
  std::vector<double> logs;
  SpreadEvidence best;
  best.gain = -1.0;
  Eigen::Index best_from = 0;
  for (Eigen::Index from = step ? 1 : 0; from < n; ++from) {
    const Eigen::Index many = step ? n - from : 1;
    const double square = normal.products.block(from, from, many, many).sum();
    const double score = normal.scores.segment(from, many).sum();
    if (!(square > kUnseen * largest)) {
      logs.push_back(0.0);  // not informative
      continue;
    }
    const double z = score / std::sqrt(square);
    logs.push_back(log_amplitude_evidence(z, kMostSeen, true));
    if (0.5 * z * z <= best.gain) continue;
    best.gain = 0.5 * z * z;
    best.mean = Eigen::VectorXd::Zero(n);
    best.mean.segment(from, many).setConstant(score / square);
    best.covariance = Eigen::MatrixXd::Zero(n, n);
    best.covariance.block(from, from, many, many).setConstant(1.0 / square);
    best_from = from;
  }
  if (logs.empty() || best.gain < 0.0) return family;
  family.log_evidence = base::log_mean(logs);
  family.gain = best.gain;
  family.columns = Eigen::MatrixXd::Zero(columns.front().rest.size(), 1);
  for (Eigen::Index c = best_from; c < (step ? n : best_from + 1); ++c) {
    family.columns.col(0) += columns[static_cast<std::size_t>(c)].rest;
  }
  family.tau = std::numeric_limits<double>::infinity();
  best.covariance *= left_of(space, best.gain);
  draw_curve(grid, best.mean, best.covariance, family);
  name_regions(family);
  return family;
}

}  // namespace

void Grid::add(double x) {
  low = std::min(low, x);
  high = std::max(high, x);
}

int bumps_over(double length, double apart, int fewest, int most) {
  return static_cast<int>(std::clamp<double>(length / apart, fewest, most));
}

double bump(double x, double middle, double width) {
  const double z = (x - middle) / width;
  return std::abs(z) > 5.0 ? 0.0 : std::exp(-0.5 * z * z);
}

UnnamedFamily family_of(GapVariable variable, GapKind what, std::string unit) {
  UnnamedFamily family;
  family.variable = variable;
  family.what = what;
  family.unit = std::move(unit);
  return family;
}

void draw_curve(const Grid& grid, const Eigen::VectorXd& sizes, const Eigen::MatrixXd& covariance,
                UnnamedFamily& family) {
  constexpr int kDrawn = 72;
  for (int j = 0; j <= kDrawn; ++j) {
    const double x = grid.low + (grid.high - grid.low) * j / kDrawn;
    Eigen::VectorXd basis(grid.bumps);
    for (int i = 0; i < grid.bumps; ++i) basis[i] = bump(x, grid.at(i), grid.width());
    double variance = 0.0;
    for (int a = 0; a < grid.bumps; ++a) {
      for (int b = 0; b < grid.bumps; ++b) variance += basis[a] * covariance(a, b) * basis[b];
    }
    family.at.push_back(x);
    family.size.push_back(basis.dot(sizes));
    family.sd.push_back(std::sqrt(std::max(0.0, variance)));
  }
}

UnnamedFamily solve(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, UnnamedFamily family,
                    SpreadEvidence& evidence) {
  const Normal normal = normal_of(space, columns);
  evidence = log_spread_evidence(normal.products, normal.scores);
  if (const double left = left_of(space, evidence.gain); left > 1.0 && evidence.mean.size() > 0) {
    const SpreadEvidence sized = log_spread_evidence(normal.products / left, normal.scores / left);
    evidence.mean = sized.mean;
    evidence.covariance = sized.covariance;
  }
  family.log_evidence = evidence.log_evidence;
  family.gain = evidence.gain;
  family.columns = rests_of(columns);
  family.tau = evidence.tau;
  return family;
}

Tried try_one(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, UnnamedFamily& family,
              SpreadEvidence& evidence) {
  UnnamedFamily one = solve(space, columns, family, evidence);
  if (one.gain <= family.gain) return {one.log_evidence, false};
  family.gain = one.gain;
  family.columns = std::move(one.columns);
  family.tau = one.tau;
  return {one.log_evidence, true};
}

void name_regions(UnnamedFamily& family) {
  const auto sureness = [&](std::size_t i) {
    return family.sd[i] > 0.0 ? std::abs(family.size[i]) / family.sd[i] : 0.0;
  };
  for (std::size_t i = 0; i < family.at.size();) {
    if (sureness(i) < kLeastPlace_sd) {
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    const bool neighbours = family.names.empty();  // members with names have none
    while (neighbours && end < family.at.size() && sureness(end) >= kLeastPlace_sd) ++end;
    UnnamedRegion region{family.at[i], family.at[end - 1], 0.0, 0.0};
    for (std::size_t k = i; k < end; ++k) {
      region.excess = std::max(region.excess, sureness(k));
      if (std::abs(family.size[k]) <= std::abs(region.size)) continue;
      region.size = family.size[k];
      region.sd = family.sd[k];
      region.at = family.at[k];
    }
    family.regions.push_back(region);
    i = end;
  }
}

void add_shapes(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, const Grid& grid,
                const UnnamedFamily& family, std::vector<UnnamedFamily>& families) {
  const Normal normal = normal_of(space, columns);
  SpreadEvidence evidence;
  families.push_back(solve(space, columns, family, evidence));
  if (evidence.mean.size() > 0) draw_curve(grid, evidence.mean, evidence.covariance, families.back());
  name_regions(families.back());
  families.push_back(one_place(space, normal, columns, grid, false, family));
  families.push_back(one_place(space, normal, columns, grid, true, family));
}

}  // namespace glidelab::diagnose
