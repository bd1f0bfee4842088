#include "core/result/quantity.h"

#include <cmath>
#include <limits>
#include <set>

#include "core/result/estimate.h"
#include "core/result/results.h"
#include "tests/catch.h"

using namespace glidelab::core;

TEST_CASE("Student's t of a variance that is estimated does not widen one that is known") {
  constexpr double kT1 = 12.7062047, kNormal = 1.95996398;  // 97.5 % quantiles, from tables
  const Estimate both = estimate(2.0, KnownVariance{1e-4, 1.0}, 25e-4);
  CHECK(both.sd == Approx(std::sqrt(26e-4)));
  CHECK(both.high95 - 2.0 == Approx(std::sqrt(kT1 * kT1 * 1e-4 + kNormal * kNormal * 25e-4)).epsilon(1e-6));
  CHECK(2.0 - both.low95 == Approx(both.high95 - 2.0));
  // Where both are known, or all of it is estimated, it is the interval of the sum.
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(estimate(0.0, KnownVariance{1e-4, infinity}, 25e-4).high95 == Approx(kNormal * std::sqrt(26e-4)).epsilon(1e-6));
  CHECK(estimate(0.0, KnownVariance{1e-4, 1.0}, 0.0).high95 == Approx(estimate(0.0, 1e-2, 1.0).high95));
}

TEST_CASE("each quantity is found by its key, and its member is its own") {
  ConfigurationResult result;
  std::set<const Quantity*> members;
  for (std::size_t i = 0; i < kQuantities.size(); ++i) {
    CHECK(place_of(kQuantities[i].key) == i);
    CHECK(symbol_of(kQuantities[i].key) == kQuantities[i].symbol);
    CHECK(unit_of(kQuantities[i].key) == kQuantities[i].unit);
    members.insert(&value_of(result, kQuantities[i].which));
  }
  CHECK(members == std::set<const Quantity*>{&result.k_over_m_1_s, &result.mu, &result.alpha_deg, &result.v_lim_m_s});
  CHECK(&value_of(result, Measurand::k_over_m) == &result.k_over_m_1_s);
  CHECK(&value_of(result, Measurand::mu) == &result.mu);
  CHECK(&value_of(result, Measurand::alpha) == &result.alpha_deg);
  CHECK(&value_of(result, Measurand::v_lim) == &result.v_lim_m_s);
}

TEST_CASE("a key that is no quantity's stays as it is and has no unit") {
  CHECK(place_of("k") == kQuantities.size());
  CHECK(symbol_of("k") == "k");
  CHECK(unit_of("k").empty());
  CHECK(quantity_keys() == std::vector<std::string>{"k_over_m_1_s", "mu", "alpha_deg", "v_lim_m_s"});
}
