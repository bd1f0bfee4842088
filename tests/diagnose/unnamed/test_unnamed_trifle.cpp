#include "diagnose/unnamed/unnamed_trifle.h"

#include <cmath>
#include <numbers>

#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// Positions that an uneven scale displaces by up to this much, with 13 mm from crest to crest.
tests::MadeEffect uneven_scale(double most_m) {
  tests::MadeEffect effect;
  effect.seen = [=](double x, double) { return x + most_m * std::sin(2.0 * std::numbers::pi * x / 0.013); };
  return effect;
}

bool is_trifle(const tests::MadeEffect& effect) {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), effect, 7);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  return diagnose::is_trifle(set, nominal, diagnose::unnamed_families(diagnose::ScoreSpace(set, nominal)));
}

}  // namespace

TEST_CASE("a displacement below the noise that moves no parameter is a trifle, a force that moves K is none") {
  CHECK(is_trifle(uneven_scale(8e-6)));
  tests::MadeEffect drag;
  drag.force = [](double, double, double v, double) { return -0.1 * v * std::abs(v); };
  CHECK_FALSE(is_trifle(drag));
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 7);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  CHECK_FALSE(diagnose::is_trifle(set, diagnose::fit_nominal(set), {}));  // nothing is known
}

TEST_CASE("what has no name, leaves no gap and moves no parameter is no verdict") {
  // By its evidence alone it is there beyond doubt: 1850 positions, each with a log likelihood of (8/30)²/4 more.
  for (const unsigned seed : {3u, 6u}) {
    CAPTURE(seed);
    const tests::MadeExperiment made =
        tests::made_experiment(tests::made_launches(), uneven_scale(8e-6), seed, 3e-5, 300);
    const diagnose::Diagnosis diagnosis =
        diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    REQUIRE(diagnosis.gap.has_value());
    REQUIRE(diagnosis.gap->before < 1.0 + diagnosis.gap->standard_error);
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
  }
}
