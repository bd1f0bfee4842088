#include "diagnose/fit/fit_neighbourhood.h"

#include <cmath>
#include <limits>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("what only the errors of derivatives determine has no size, and what the data determine has its own") {
  // Two sizes of which the data see the difference (information 1e6) and, by rounding, the sum (1e-9 of it).
  Eigen::MatrixXd products(2, 2);
  const double difference = 1e6, sum = 1e-3;
  products << difference + sum, sum - difference, sum - difference, difference + sum;
  Eigen::VectorXd scores(2);
  scores << 2.0 * difference + 20.0 * sum, -2.0 * difference + 20.0 * sum;  // sizes 11 and 9, as it were
  const auto evidence = diagnose::log_spread_evidence(products, scores);
  CHECK(evidence.mean[0] - evidence.mean[1] == Approx(2.0).epsilon(1e-3));
  CHECK(std::abs(evidence.mean[0] + evidence.mean[1]) < 1e-6);
}

TEST_CASE("sizes with which a motion runs off say nothing") {
  Eigen::MatrixXd products = Eigen::MatrixXd::Identity(3, 3);
  Eigen::VectorXd scores = Eigen::VectorXd::Ones(3);
  REQUIRE(diagnose::log_spread_evidence(products, scores).mean.size() == 3);
  for (const double broken : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    Eigen::MatrixXd far = products;
    far(1, 1) = broken;
    CHECK(diagnose::log_spread_evidence(far, scores).mean.size() == 0);
    CHECK(diagnose::log_spread_evidence(far, scores).log_evidence == 0.0);
    Eigen::VectorXd off = scores;
    off[2] = broken;
    CHECK(diagnose::log_spread_evidence(products, off).mean.size() == 0);
  }
}
