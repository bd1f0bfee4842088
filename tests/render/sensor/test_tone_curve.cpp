#include "render/sensor/sensor.h"

#include <cmath>
#include <vector>

#include "tests/catch.h"

using namespace glidelab::render;

namespace {

// Double precision: a few roundings of numbers up to 1.
constexpr double kExact = 1e-14;

std::vector<ToneCurve> all_curves() {
  return {{},
          {ToneCurve::Kind::gamma, 2.2, {}, {}},
          {ToneCurve::Kind::bt709, 2.2, {}, {}},
          {ToneCurve::Kind::table, 2.2, {0.0, 0.1, 0.5, 1.0}, {0.0, 0.3, 0.9, 1.0}}};
}

}  // namespace

TEST_CASE("Tone curves take the values of their formulas") {
  const std::vector<ToneCurve> curves = all_curves();
  CHECK(curves[0](0.3) == 0.3);
  CHECK(std::abs(curves[1](0.25) - std::exp(std::log(0.25) / 2.2)) < kExact);
  // BT.709 has 0.0811 at its corner, from both sides within 3e-4 (its constants are rounded).
  CHECK(std::abs(curves[2](0.018 - 1e-12) - 0.081) < 1e-9);
  CHECK(std::abs(curves[2](0.018) - 0.081) < 3e-4);
  CHECK(std::abs(curves[2](0.5) - (1.099 * std::pow(0.5, 0.45) - 0.099)) < kExact);
  CHECK(std::abs(curves[3](0.3) - 0.6) < kExact);  // half way from (0.1, 0.3) to (0.5, 0.9)
}

TEST_CASE("Tone curves rise from 0 to 1, and their inverses undo them") {
  for (const ToneCurve& curve : all_curves()) {
    CAPTURE(name_of(curve.kind));
    CHECK(curve(0.0) == 0.0);
    CHECK(std::abs(curve(1.0) - 1.0) < kExact);
    CHECK(curve(1.7) == curve(1.0));
    double last = -1.0;
    for (int i = 0; i <= 1000; ++i) {
      const double x = i / 1000.0;
      CHECK(curve(x) > last);
      last = curve(x);
      // At BT.709's corner the inverse may take the other branch, 1e-4 off.
      CHECK(std::abs(curve.inverse(curve(x)) - x) < (std::abs(x - 0.018) < 1e-3 ? 1e-4 : 1e-12));
    }
  }
}
