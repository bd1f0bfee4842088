#include "diagnose/fit/fit_neighbourhood.h"

#include <cmath>

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
