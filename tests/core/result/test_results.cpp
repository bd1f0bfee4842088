#include "core/result/results.h"

#include "core/result/estimate.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kG = 9.80665;

/// The configuration of one line.
core::ConfigurationResult falling(double incline_deg, double a0_m_s2, double sd_m_s2) {
  core::ConfigurationResult one;
  one.incline_deg = incline_deg;
  core::LineFit line;
  line.direction = incline_deg < 0.0 ? -1 : 1;  // downhill
  line.a0_m_s2 = core::estimate(a0_m_s2, sd_m_s2, 20.0);
  one.lines = {line};
  return one;
}

bool is_slow(double incline_deg, double a0_m_s2, double sd_m_s2) {
  return core::slow_fall(falling(incline_deg, a0_m_s2, sd_m_s2), kG).has_value();
}

}  // namespace

TEST_CASE("a fall that begins below a third of gravity, by three standard deviations, is slow") {
  CHECK(is_slow(90.0, kG / 16.0, 0.01));    // times four times too long
  CHECK(is_slow(90.0, kG / 4.0, 0.1));      // twice
  CHECK(is_slow(-90.0, -kG / 16.0, 0.01));  // counted upwards
  CHECK(is_slow(80.0, 0.04, 0.01));
  CHECK_FALSE(is_slow(79.0, 0.04, 0.01));  // no fall
  CHECK_FALSE(is_slow(4.0, 0.68, 0.01));
  // A shuttlecock on its way up: a = g (1 + v²/vt²) over 0 to 15 m/s, vt = 7 m/s. Its line begins near g (1 -
  // 15²/6/7²).
  core::ConfigurationResult thrown = falling(90.0, kG * (1.0 - 225.0 / 6.0 / 49.0), 0.01);
  thrown.lines[0].direction = -1;
  CHECK_FALSE(core::slow_fall(thrown, kG).has_value());
  CHECK_FALSE(is_slow(90.0, 1.0, 0.8));  // uncertain: g/3 = 3.3 is within three of them
  // An inflated ball of three times the density of the air: g (3 - 1)/(3 + 1/2) = 0.57 g.
  CHECK_FALSE(is_slow(90.0, kG * 2.0 / 3.5, 0.01));
  CHECK_FALSE(core::slow_fall(falling(90.0, 0.6, 0.01), 0.0).has_value());  // gravity is not known
}
