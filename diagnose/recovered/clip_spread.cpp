#include "diagnose/recovered/clip_spread.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/math/dense.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastKnown = 1e-3;      // of the prior's information: a direction with less is open
constexpr double kLeastOfLargest = 1e-9;  // of the largest information
constexpr double kBelow = 0.1;            // probability of a chi² as low as that of the upper limit

/// What the data say along one direction of the values: y with its variance, and the part of the mean in it.
struct Direction {
  double y = 0.0, variance = 0.0, of_mean = 0.0;
};

double chi2_about_mean(const std::vector<Direction>& directions, double between) {
  double weight = 0.0, sum = 0.0, chi2 = 0.0;
  for (const Direction& one : directions) {
    weight += one.of_mean * one.of_mean / (one.variance + between);
    sum += one.of_mean * one.y / (one.variance + between);
  }
  const double mean = weight > 0.0 ? sum / weight : 0.0;
  for (const Direction& one : directions) {
    const double off = one.y - mean * one.of_mean;
    chi2 += off * off / (one.variance + between);
  }
  return chi2;
}

/// The variance between clips at which chi² is as large as this; 0 if it never is, at most the prior's.
double variance_at(const std::vector<Direction>& directions, double chi2, double most) {
  const auto more = [&](double between) { return chi2_about_mean(directions, between) - chi2; };
  if (!(more(0.0) > 0.0)) return 0.0;
  if (!(more(most) < 0.0)) return most;
  std::uintmax_t steps = 100;
  return boost::math::tools::toms748_solve(more, 0.0, most, boost::math::tools::eps_tolerance<double>(30), steps)
      .second;
}

}  // namespace

ClipSpread clip_spread(const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance, double prior_sd) {
  const double prior = prior_sd * prior_sd;
  const Eigen::MatrixXd precision = base::inverse_positive(covariance);
  const auto n = values.size();
  const base::SymmetricEigen of_data = base::symmetric_eigen(precision - Eigen::MatrixXd::Identity(n, n) / prior);
  const Eigen::VectorXd score = of_data.vectors.transpose() * base::product(precision, values);
  const double least = std::max(kLeastKnown / prior, kLeastOfLargest * of_data.values[n - 1]);
  std::vector<Direction> directions;
  double information = 0.0, in_mean = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double known = of_data.values[k];
    if (!(known > least)) continue;
    const double of_mean = of_data.vectors.col(k).sum();
    directions.push_back({score[k] / known, 1.0 / known, of_mean});
    information += known;
    in_mean += of_mean * of_mean;
  }
  // The mean of deviations from a common value is open itself, so that it is seldom among the directions.
  const bool has_mean = in_mean > kLeastKnown * static_cast<double>(n);
  if (!has_mean) {
    for (Direction& one : directions) one.of_mean = 0.0;
  }
  const double freedom = static_cast<double>(directions.size()) - (has_mean ? 1.0 : 0.0);
  if (!(freedom >= 1.0)) return {0.0, prior};
  const boost::math::chi_squared by_chance(freedom);
  const double limit = variance_at(directions, boost::math::quantile(by_chance, kBelow), prior);
  const double of_one = static_cast<double>(directions.size()) / information;  // no less than the data can show
  return {variance_at(directions, freedom, prior), std::min(prior, std::max(limit, of_one))};
}

}  // namespace glidelab::diagnose
