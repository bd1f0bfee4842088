#include "diagnose/causes/gap_levels.h"

#include <cmath>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

diagnose::GapLevels levels(const tests::MadeEffect& effect, unsigned seed) {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), effect, seed);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  return diagnose::levels_of(set, diagnose::fit_nominal(set), 1);
}

}  // namespace

TEST_CASE("the law holds at every level if nothing is missing") {
  const diagnose::GapLevels of = levels({}, 3);
  REQUIRE(of.configuration);
  REQUIRE(of.clip);
  // 8 clips of about 150 positions: the standard error of a gap is sqrt(1.82/1200) = 0.04; three of these.
  CHECK(std::abs(of.all - 1.0) < 0.12);
  CHECK(std::abs(*of.configuration - 1.0) < 0.12);
  CHECK(std::abs(*of.clip - 1.0) < 0.12);
  CHECK(!of.holds_within);
}

TEST_CASE("a friction that differs between masses leaves the law within each configuration") {
  tests::MadeEffect effect;
  effect.force = [](double m, double, double v, double) {
    const double more = m > 0.4 ? 0.001 : -0.001;  // of mu
    return v == 0.0 ? 0.0 : -(v > 0.0 ? 1.0 : -1.0) * more * m * 9.80665;
  };
  const diagnose::GapLevels of = levels(effect, 4);
  REQUIRE(of.configuration);
  CHECK(of.all > 1.5);
  CHECK(std::abs(*of.configuration - 1.0) < 0.15);
  CHECK(of.holds_within);
}

TEST_CASE("a force that depends on position breaks the law within a configuration too") {
  tests::MadeEffect effect;
  effect.force = [](double m, double x, double, double) { return m * 9.80665 * 2e-3 * std::sin(9.0 * x); };
  const diagnose::GapLevels of = levels(effect, 5);
  REQUIRE(of.configuration);
  CHECK(of.all > 2.0);
  CHECK(*of.configuration > 1.5);
  CHECK(!of.holds_within);
}
