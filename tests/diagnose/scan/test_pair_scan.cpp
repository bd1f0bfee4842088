#include "diagnose/scan/effect_scan.h"

#include <set>

#include "diagnose/fit/nominal_fit.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

double sign_of(double v) {
  return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
}

/// A friction that does not depend on the load, and a pattern that was not in the plane of motion.
tests::MadeExperiment masked(unsigned seed) {
  const tests::MadeEffect effect{.force = [](double, double, double v, double) { return -0.008 * sign_of(v); },
                                 .seen = [](double x, double) { return x / (1.0 + 0.015 * x); }};
  std::vector<tests::MadeLaunch> launches;
  for (const double mass : {0.342, 0.479, 0.642}) {
    launches.push_back({mass, 0.0, 0.5, -1.2});
    launches.push_back({mass, 0.0, -0.5, 1.0});
  }
  return tests::made_experiment(launches, effect, seed, 1e-4, 150, 100.0);
}

}  // namespace

TEST_CASE("two effects, each of which alone explains less than others do, are found together") {
  const auto made = masked(1);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::ScoreSpace space(set, nominal);
  const auto pairs = diagnose::scan_pairs(space, diagnose::scan_effects(space, {}, 2));
  REQUIRE(pairs.size() > 1);
  const std::set<std::size_t> first = {pairs.front().first, pairs.front().second};
  CHECK(first == std::set<std::size_t>{diagnose::effect_index("load_independent_friction"),
                                       diagnose::effect_index("perspective_error")});
  for (std::size_t i = 1; i < pairs.size(); ++i) CHECK(pairs[i].log_evidence <= pairs[i - 1].log_evidence);
}

TEST_CASE("two equal directions make no pair") {
  const auto made = masked(1);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::ScoreSpace space(set, nominal);
  std::vector<diagnose::EffectScan> twice = {diagnose::scan_effect(space, diagnose::effect_index("perspective_error")),
                                             diagnose::scan_effect(space, diagnose::effect_index("perspective_error"))};
  twice[1].effect += 1;
  CHECK(diagnose::scan_pairs(space, twice).empty());
}
