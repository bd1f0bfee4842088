#include "core/result/quantity.h"

#include <set>

#include "core/result/results.h"
#include "tests/catch.h"

using namespace glidelab::core;

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
