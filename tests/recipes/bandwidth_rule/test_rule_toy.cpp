#include <cmath>
#include <random>
#include <vector>

#include "core/motion/bandwidth/bandwidth_rule.h"
#include "tests/catch.h"

using namespace glidelab::core;

TEST_CASE("the toy rule is known by its name, and its bandwidth is the geometric mean of the two") {
  std::vector<double> t, x;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 1e-4);
  for (int i = 0; i <= 200; ++i) {
    t.push_back(i / 200.0);
    x.push_back(-std::expm1(-2.8 * t.back()) / 2.8 + noise(random));
  }
  BandwidthProblem problem;
  problem.parts.push_back({t, x});
  problem.noise.autocovariance = {1e-8};
  problem.noise.sd_m = 1e-4;
  problem.step_s = 1.0 / 200.0;
  const auto chosen = [&](const char* rule) {
    INFO(rule);
    REQUIRE(find_bandwidth_rule(rule));
    const auto pick = find_bandwidth_rule(rule)->choose(problem);
    REQUIRE(pick);
    return pick->bandwidth_s;
  };
  const double toy = chosen("toy");
  CHECK(toy * toy == Approx(chosen("plug-in") * chosen("ebbs")).epsilon(1e-12));
}
