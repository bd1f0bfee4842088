#include "validate/oracle_bandwidth.h"

#include <cmath>

#include "catch.h"
#include "core/kernel_constants.h"

using namespace glidelab;

TEST_CASE("the best bandwidth for a motion with one x'''' everywhere is the asymptotic one") {
  // x = t^4 / 4!, x'''' = 1: bias h^2/2 and variance 0.2116 s^2 dt / h^5 are exact inside, and kernels are complete
  // there: six bandwidths are less than a tenth of the stretch.
  std::vector<double> t, x, a;
  for (int i = 0; i <= 2000; ++i) {
    t.push_back(0.005 * i);
    x.push_back(std::pow(t.back() - 5.0, 4) / 24.0);
    a.push_back(std::pow(t.back() - 5.0, 2) / 2.0);
  }
  const double variance = 1e-8;
  const double expected = std::pow(core::kGaussianA.best_h9() * variance * 0.005, 1.0 / 9.0);
  REQUIRE(6.0 * expected < 1.0);
  const auto best = validate::best_bandwidth({{t, x, a}}, {variance});
  REQUIRE(best);
  CHECK(best->bandwidth_s == Approx(expected).epsilon(2e-3));  // the search's last ratio is 1.001
  const double square = 0.25 * std::pow(expected, 4) + 0.2115711 * variance * 0.005 / std::pow(expected, 5);
  CHECK(best->mean_square_m2_s4 == Approx(square).epsilon(1e-4));  // the kernel's cut at 6 h, see local_cubic.h
  CHECK(*validate::true_error({{t, x, a}}, {variance}, 1.2 * expected) > best->mean_square_m2_s4);
}

TEST_CASE("a stretch without points inside has no best bandwidth") {
  const std::vector<double> t{0.0, 0.1}, x{0.0, 0.0};
  CHECK_FALSE(validate::best_bandwidth({{t, x, x}}, {1.0}));
}
