#include "core/experiment/local_gravity.h"

#include <cmath>

#include "tests/catch.h"

using glidelab::core::gravity_sd_m_s2;
using glidelab::core::stated_gravity;

// A number rounded to a step q has a standard deviation of q/sqrt(12).
TEST_CASE("a stated gravity is known to its last digit") {
  CHECK(gravity_sd_m_s2(9.82) == Approx(0.01 / std::sqrt(12.0)).epsilon(1e-12));
  CHECK(gravity_sd_m_s2(9.8123) == Approx(0.0001 / std::sqrt(12.0)).epsilon(1e-12));
  CHECK(gravity_sd_m_s2(0.00001625) == Approx(1e-8 / std::sqrt(12.0)).epsilon(1e-12));
}

TEST_CASE("the standard gravity, the textbooks' 9.81 and one of a single decimal are known as well as the latitude") {
  CHECK(gravity_sd_m_s2(9.80665) == 0.015);
  CHECK(gravity_sd_m_s2(9.81) == 0.015);
  CHECK(gravity_sd_m_s2(9.8) == 0.015);
  CHECK(gravity_sd_m_s2(10.0) == 0.015);
}

TEST_CASE("gravity has the standard deviation that is stated, otherwise that of its digits") {
  CHECK(stated_gravity({}).m_s2 == 9.80665);
  CHECK(stated_gravity({}).sd_m_s2 == 0.015);
  CHECK(stated_gravity(9.80665).sd_m_s2 == 0.015);
  CHECK(stated_gravity(9.81).sd_m_s2 == 0.015);
  CHECK(stated_gravity(9.8123).m_s2 == 9.8123);
  CHECK(stated_gravity(9.8123).sd_m_s2 == gravity_sd_m_s2(9.8123));
  CHECK(stated_gravity(9.81, 0.0001).sd_m_s2 == 0.0001);
  CHECK(stated_gravity(9.80665, 0.0).sd_m_s2 == 0.0);
}
