#include "diagnose/verdict/unnamed_trifle.h"

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

/// Positions that an uneven scale displaces by a quarter of their noise, with 0.1 m from crest to crest.
tests::MadeEffect uneven_scale() {
  tests::MadeEffect effect;
  effect.seen = [](double x, double) { return x + 8e-6 * std::sin(2.0 * std::numbers::pi * x / 0.1); };
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
  CHECK(is_trifle(uneven_scale()));
  tests::MadeEffect drag;
  drag.force = [](double, double, double v, double) { return -0.1 * v * std::abs(v); };
  CHECK_FALSE(is_trifle(drag));
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 7);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  CHECK_FALSE(diagnose::is_trifle(set, diagnose::fit_nominal(set), {}));  // nothing is known
}

TEST_CASE("what has no name, leaves no gap and moves no parameter is no verdict") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), uneven_scale(), 7);
  const diagnose::Diagnosis diagnosis =
      diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  CHECK(diagnosis.verdict == diagnose::Verdict::none);
}
