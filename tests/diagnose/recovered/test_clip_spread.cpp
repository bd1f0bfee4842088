#include "diagnose/recovered/clip_spread.h"

#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kPrior = 0.02;

/// A fit's values and their covariance, from what the data say (`known` is their information) and the prior.
struct Fitted {
  Eigen::VectorXd values;
  Eigen::MatrixXd covariance;
};

Fitted fitted(const Eigen::VectorXd& by_data, const Eigen::MatrixXd& known) {
  const Eigen::Index n = by_data.size();
  const Eigen::MatrixXd covariance = (known + Eigen::MatrixXd::Identity(n, n) / (kPrior * kPrior)).inverse();
  return {covariance * known * by_data, covariance};
}

Eigen::VectorXd six() {
  Eigen::VectorXd values(6);
  values << 0.003, -0.002, 0.001, -0.004, 0.0025, -0.0005;
  return values;
}

double variance_of(const Eigen::VectorXd& values) {
  return (values.array() - values.mean()).square().sum() / (static_cast<double>(values.size()) - 1.0);
}

/// The information of values with independent errors of which the mean, and further directions, are open.
Eigen::MatrixXd known_but(const Eigen::MatrixXd& open, double sd) {
  const Eigen::Index n = open.rows();
  Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index k = 0; k < open.cols(); ++k)
    rest -= open.col(k) * open.col(k).transpose() / open.col(k).squaredNorm();
  return rest / (sd * sd);
}

}  // namespace

TEST_CASE("clips that are known equally well differ by their variance, less that of their errors") {
  constexpr double kError = 1e-3;
  const Fitted fit = fitted(six(), known_but(Eigen::VectorXd::Ones(6), kError));
  const diagnose::ClipSpread spread = diagnose::clip_spread(fit.values, fit.covariance, kPrior);
  CHECK(spread.variance == Approx(variance_of(six()) - kError * kError).epsilon(1e-6));
  // Q = 5 (s² - V...)/(e² + V): the limit is where it is the 10 % quantile of chi² with 5 degrees of freedom, 1.6103.
  CHECK(spread.most == Approx(5.0 * variance_of(six()) / 1.6103 - kError * kError).epsilon(1e-3));
}

TEST_CASE("clips that differ by no more than their errors have no spread, and one no narrower than the errors") {
  constexpr double kError = 0.01;
  const Fitted fit = fitted(six(), known_but(Eigen::VectorXd::Ones(6), kError));
  const diagnose::ClipSpread spread = diagnose::clip_spread(fit.values, fit.covariance, kPrior);
  CHECK(spread.variance == 0.0);
  CHECK(spread.most >= kError * kError * (1.0 - 1e-9));
}

TEST_CASE("a direction that the data leave open says nothing of how clips differ") {
  // Clips go up and down in turn, and the inclination is not known: one friction for each direction is open.
  Eigen::MatrixXd open(6, 2);
  open.col(0).setOnes();
  open.col(1) << 1.0, -1.0, 1.0, -1.0, 1.0, -1.0;
  constexpr double kError = 1e-4;
  const Fitted fit = fitted(six(), known_but(open, kError));
  const diagnose::ClipSpread spread = diagnose::clip_spread(fit.values, fit.covariance, kPrior);
  // About the mean of each direction, with four degrees of freedom.
  double squares = 0.0;
  for (const Eigen::Index first : {0, 1}) {
    const Eigen::Vector3d one(six()[first], six()[first + 2], six()[first + 4]);
    squares += 2.0 * variance_of(one);
  }
  CHECK(spread.variance == Approx(squares / 4.0 - kError * kError).epsilon(1e-4));
  // The plain sum of squares less the trace of the covariance is far below 0.
  const double trace = fit.covariance.trace() - fit.covariance.sum() / 6.0;
  CHECK((fit.values.array() - fit.values.mean()).square().sum() - trace < 0.0);
}
