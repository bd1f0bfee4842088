#include "base/math/distributions.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("quantiles of chi² and of the normal distribution are those of the tables") {
  // Of two degrees of freedom -2 ln(1 - p); of others by the tables.
  for (const double p : {1e-4, 0.01, 0.5, 0.99}) {
    CHECK(base::chi2_quantile(2.0, p) == Approx(-2.0 * std::log1p(-p)).epsilon(1e-9));
    CHECK(base::chi2_upper_quantile(2.0, p) == Approx(-2.0 * std::log(p)).epsilon(1e-9));
  }
  CHECK(base::chi2_quantile(8.0, 0.01) == Approx(1.6465).epsilon(1e-4));
  CHECK(base::chi2_quantile(20.0, 0.99) == Approx(37.566).epsilon(1e-4));
  CHECK(base::chi2_quantile(7.0, 0.05) == Approx(2.1673).epsilon(1e-4));
  CHECK(base::normal_quantile(0.95) == Approx(1.6448536269514722).epsilon(1e-9));
  CHECK(base::normal_quantile(0.01) == Approx(-2.3263478740408408).epsilon(1e-9));
  CHECK(base::normal_upper_quantile(0.01) == Approx(2.3263478740408408).epsilon(1e-9));
}

TEST_CASE("tails of the normal distribution are those of the error function") {
  for (const double z : {-3.0, -0.5, 0.0, 1.0, 6.0}) {
    CHECK(base::normal_tail(z) == Approx(0.5 * std::erfc(z / std::numbers::sqrt2)).epsilon(1e-12));
    CHECK(base::normal_cdf(z) == Approx(0.5 * std::erfc(-z / std::numbers::sqrt2)).epsilon(1e-12));
  }
}

TEST_CASE("Student's t of one degree of freedom is Cauchy's distribution, and beta of (a, 1) a power") {
  for (const double p : {0.01, 0.3, 0.975}) {
    CHECK(base::student_t_quantile(1.0, p) == Approx(std::tan(std::numbers::pi * (p - 0.5))).epsilon(1e-9));
    CHECK(base::beta_quantile(3.5, 1.0, p) == Approx(std::pow(p, 1.0 / 3.5)).epsilon(1e-9));
  }
  for (const double t : {-2.0, 0.1, 12.0}) {
    CHECK(base::student_t_tail(1.0, t) == Approx(0.5 - std::atan(t) / std::numbers::pi).epsilon(1e-9));
  }
}

TEST_CASE("Student's t of infinitely many degrees of freedom is the normal distribution") {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double p : {0.01, 0.3, 0.975}) {
    CHECK(base::student_t_quantile(kInfinite, p) == Approx(base::normal_quantile(p)).epsilon(1e-12));
  }
  for (const double t : {-2.0, 0.1, 6.0}) {
    CHECK(base::student_t_tail(kInfinite, t) == Approx(0.5 * std::erfc(t / std::numbers::sqrt2)).epsilon(1e-12));
  }
}
