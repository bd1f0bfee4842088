#include "base/math/log_sum.h"

#include <cmath>
#include <limits>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("sums and means of what is known by its logarithm") {
  CHECK(base::log_sum({std::log(2.0), std::log(3.0)}) == Approx(std::log(5.0)).epsilon(1e-14));
  CHECK(base::log_mean({std::log(2.0), std::log(3.0)}) == Approx(std::log(2.5)).epsilon(1e-14));
  // Where exp() itself would overflow, and where it would be zero.
  CHECK(base::log_sum({1e5, 1e5}) == Approx(1e5 + std::log(2.0)).epsilon(1e-14));
  CHECK(base::log_sum({-1e5, -1e5 - 800.0}) == Approx(-1e5).epsilon(1e-14));
  const double none = -std::numeric_limits<double>::infinity();
  CHECK(base::log_sum({none, none}) == none);
}
