#include "diagnose/line_table.h"

#include <cmath>
#include <numbers>
#include <random>

#include "base/errors.h"
#include "catch.h"

using namespace glidelab;

namespace {

constexpr double kGravity = 9.80665, kDrag = 0.93, kMu = 0.006;

/// Lines level and at 4 degrees, both ways, by equation (8) with a friction force that no load makes; intercepts
/// scatter by 1 mm/s², slopes by 0.1 %.
std::vector<diagnose::TableLine> lines_with(double friction_n, unsigned seed,
                                            const std::vector<double>& masses = {0.2, 0.3, 0.45, 0.7, 1.0, 1.5}) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<diagnose::TableLine> lines;
  for (const double degrees : {0.0, 4.0}) {
    const double alpha = degrees * std::numbers::pi / 180.0;
    for (const double mass : masses) {
      for (const int direction : {-1, 1}) {
        const double friction = kMu * kGravity * std::cos(alpha) + friction_n / mass;
        lines.push_back({mass, degrees, direction,
                         kGravity * std::sin(alpha) - direction * friction + 1e-3 * normal(random),
                         kDrag / mass * (1.0 + 1e-3 * normal(random))});
      }
    }
  }
  return lines;
}

}  // namespace

TEST_CASE("published lines: a friction that does not grow with the load is found, with its size") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const diagnose::Diagnosis diagnosis = diagnose::diagnose_lines(lines_with(0.03, seed), kGravity);
    REQUIRE(diagnosis.verdict == "effect");
    CHECK(diagnosis.effects.front().id == "load_independent_friction");
    const auto& size = diagnosis.effects.front().parameters.front();
    CHECK(size.key == "force_n");
    CHECK(std::abs(size.value - 0.03) < 4.0 * size.sd);
    CHECK(size.sd < 0.003);
  }
}

TEST_CASE("published lines with nothing wrong: nothing is missing, also where they are few") {
  const auto false_alarms = [](const std::vector<double>& masses) {
    int count = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
      count += diagnose::diagnose_lines(lines_with(0.0, seed, masses), kGravity).verdict == "none" ? 0 : 1;
    }
    return count;
  };
  // One in twenty is allowed, one in ten of a dozen lines whose scatter nobody states; three standard errors of these.
  CHECK(false_alarms({0.2, 0.3, 0.45, 0.7, 1.0, 1.5}) <= 10 + 9);
  CHECK(false_alarms({0.335, 0.435, 0.535}) <= 20 + 12);
}

TEST_CASE("published lines tell of no accelerations") {
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_lines(lines_with(0.0, 4), kGravity);
  REQUIRE(diagnosis.gap);
  CHECK_FALSE(diagnosis.gap->acceleration_before);
  CHECK_FALSE(diagnosis.gap->acceleration_after);
}

TEST_CASE("a handful of published lines carries no verdict") {
  std::vector<diagnose::TableLine> few = lines_with(0.0, 1);
  few.resize(5);
  CHECK_THROWS_AS(diagnose::diagnose_lines(few, kGravity), base::InputError);
}
