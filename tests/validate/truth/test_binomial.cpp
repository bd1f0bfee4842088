#include "validate/truth/binomial.h"

#include <cmath>

#include "tests/catch.h"

using namespace glidelab::validate;

TEST_CASE("the binomial distribution of ten throws of a coin is counted exactly") {
  // 1, 10, 45 of 1024.
  CHECK(std::abs(binomial_cdf(0, 10, 0.5) - 1.0 / 1024) < 1e-13);
  CHECK(std::abs(binomial_cdf(2, 10, 0.5) - 56.0 / 1024) < 1e-13);
  CHECK(binomial_cdf(-1, 10, 0.5) == 0.0);
  CHECK(binomial_cdf(10, 10, 0.5) == 1.0);
}

TEST_CASE("a two-sided p-value is twice the smaller tail, and never above 1") {
  CHECK(std::abs(binomial_p_value(2, 10, 0.5) - 112.0 / 1024) < 1e-12);
  CHECK(std::abs(binomial_p_value(8, 10, 0.5) - 112.0 / 1024) < 1e-12);
  CHECK(binomial_p_value(5, 10, 0.5) == 1.0);
}

TEST_CASE("the interval of a proportion has Clopper and Pearson's closed ends where all or none hit") {
  // 1 - (alpha / 2)^(1/n)
  const double end = 1.0 - std::pow(0.025, 1.0 / 20.0);
  CHECK(proportion_interval(0, 20, 0.95).low == 0.0);
  CHECK(std::abs(proportion_interval(0, 20, 0.95).high - end) < 1e-8);
  CHECK(std::abs(proportion_interval(20, 20, 0.95).low - (1.0 - end)) < 1e-8);
  CHECK(proportion_interval(20, 20, 0.95).high == 1.0);
}

TEST_CASE("at the ends of its interval a proportion's tail is half of what is left of the confidence") {
  const ProportionInterval interval = proportion_interval(943, 1000, 0.95);
  CHECK(std::abs(1.0 - binomial_cdf(942, 1000, interval.low) - 0.025) < 1e-6);
  CHECK(std::abs(binomial_cdf(943, 1000, interval.high) - 0.025) < 1e-6);
}
