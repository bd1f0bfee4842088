#include "core/result/uphill.h"

#include "tests/catch.h"

using namespace glidelab;

namespace {

core::InclineContradiction between(double stated_deg, double found_deg) {
  core::InclineContradiction of;
  of.stated = {stated_deg, {}, "incline_deg"};
  of.deg = found_deg;
  of.sd_deg = 0.01;
  of.gravity_m_s2 = 9.80665;
  of.gross = true;
  return of;
}

}  // namespace

TEST_CASE("an inclination near minus the stated one says that x is positive uphill, another one does not") {
  CHECK(core::seems_uphill(between(4.0, -4.31)));
  CHECK(core::seems_uphill(between(-30.0, 33.0)));
  CHECK_FALSE(core::seems_uphill(between(4.0, -7.0)));  // off by more than a degree and a quarter, either way
  CHECK_FALSE(core::seems_uphill(between(4.0, 14.0)));
  CHECK_FALSE(core::seems_uphill(between(4.0, 0.0)));
  core::InclineContradiction careless = between(0.4, -0.4);
  careless.gross = false;
  CHECK_FALSE(core::seems_uphill(careless));
  core::InclineContradiction bound = between(4.0, -4.3);
  bound.bound = -1;
  CHECK(core::seems_uphill(bound));
  bound = between(29.0, -23.0);  // "at most -23": -29 is
  bound.bound = -1;
  CHECK(core::seems_uphill(bound));
  bound = between(-29.0, 23.0);
  bound.bound = 1;
  CHECK(core::seems_uphill(bound));
  bound = between(4.0, 1.0);
  bound.bound = -1;
  CHECK_FALSE(core::seems_uphill(bound));
  bound = between(4.0, -20.0);
  bound.bound = -1;
  CHECK_FALSE(core::seems_uphill(bound));
}
