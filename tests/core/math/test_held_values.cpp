#include "core/math/held_values.h"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kLogger_hz = 100.0;

/// What a logger writes of a sensor that gives a new value every `every` rows.
std::vector<double> logged(const std::function<double(double)>& x, std::size_t rows, std::size_t every,
                           double rounding_m = 0.0) {
  std::vector<double> values;
  for (std::size_t row = 0; row < rows; ++row) {
    const double at = x(static_cast<double>(row - row % every) / kLogger_hz);
    values.push_back(rounding_m > 0.0 ? std::round(at / rounding_m) * rounding_m : at);
  }
  return values;
}

double speeding_up(double t_s) {
  return 0.3 + 0.5 * t_s + 0.2 * t_s * t_s;
}

}  // namespace

TEST_CASE("rows in which a logger waits for a slower sensor are held values, and the sensor's own are not") {
  for (const double rounding_m : {0.0, 0.001, 0.01}) {
    for (const std::size_t every : {2, 3, 7}) {
      CAPTURE(rounding_m, every);
      const auto held = core::held_values(logged(speeding_up, 120, every, rounding_m));
      // At two rows, and 1 cm of it, most steps are one unit of the rounding: nothing tells it from a slow body.
      const bool told = rounding_m < 0.01 || every > 2;
      REQUIRE(held.has_value() == told);
      if (!told) continue;
      CHECK(held->usual == every);
      for (std::size_t row = 0; row < 120; ++row) CHECK(held->is_held[row] == (row % every != 0));
      CHECK(held->count == 120 - (120 + every - 1) / every);
    }
  }
}

TEST_CASE("a slow body whose rounded position repeats is not held by its sensor, nor is one that rests") {
  const auto slow = [](double t_s) { return 0.1 + 0.2 * t_s; };
  CHECK_FALSE(core::held_values(logged(slow, 200, 1, 0.01)));
  const auto stops = [](double t_s) { return t_s < 0.5 ? speeding_up(t_s) : speeding_up(0.5); };
  CHECK_FALSE(core::held_values(logged(stops, 200, 1)));
  CHECK_FALSE(core::held_values(std::vector<double>(200, 0.3)));
  CHECK_FALSE(core::held_values({}));
}

TEST_CASE("a sensor whose new values come unevenly, now and then in the next row, holds its values too") {
  std::vector<double> values;
  std::size_t brought = 0;
  for (int many = 0; values.size() < 150; ++many, ++brought) {
    const double at = speeding_up(static_cast<double>(values.size()) / kLogger_hz);
    values.resize(values.size() + static_cast<std::size_t>(many % 3 == 0 ? 1 : 4 + many % 5), at);
  }
  const auto held = core::held_values(values);
  REQUIRE(held);
  CHECK(values.size() - held->count == brought);
}

TEST_CASE("a rest seen by a slow sensor keeps a row for each of its values") {
  const auto rests_between = [](double t_s) {
    return t_s < 0.7 ? speeding_up(t_s) : t_s < 1.4 ? speeding_up(0.7) : speeding_up(t_s - 0.7);
  };
  const auto held = core::held_values(logged(rests_between, 210, 7));
  REQUIRE(held);
  CHECK(held->usual == 7);
  for (std::size_t row = 0; row < 210; ++row) CHECK(held->is_held[row] == (row % 7 != 0));
}
