#include <cmath>
#include <string>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/rounded_positions.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/verdict/diagnose.h"
#include "diagnose/verdict/likely_explanations.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kG = 9.80665, kMass_kg = 8e-3;

/// One fall from rest at 50 Hz, with a drag of c v² and air that moves along, rounded to `step_m`.
tests::MadeExperiment coarse_fall(double c_kg_m, double air_kg, double noise_m, double step_m, std::size_t frames,
                                  unsigned seed) {
  tests::MadeEffect air;
  air.force = [=](double, double, double v, double) { return -c_kg_m * v * std::abs(v); };
  tests::MadeExperiment made =
      tests::made_experiment({{kMass_kg, 90.0, 0.0, 1e-6, 0.0, 0.0, 1.0 + air_kg / kMass_kg}}, air, seed, noise_m,
                             frames, 50.0, 0.0, 0.0, {.k_n_s_m = 0.0, .mu = 0.0, .gravity_m_s2 = kG});
  for (core::MotionPoint& point : made.results.clips.front().motion) {
    if (point.measured_m && step_m > 0.0) *point.measured_m = step_m * std::round(*point.measured_m / step_m);
  }
  return made;
}

}  // namespace

TEST_CASE("a fall through air is braked by air, however coarsely its positions are rounded") {
  constexpr double kDrag_kg_m = 0.0116;  // a terminal velocity of 2.6 m/s
  int named = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    const tests::MadeExperiment made = coarse_fall(kDrag_kg_m, 3.2e-3, 1e-3, 0.01, 23, seed);
    REQUIRE(diagnose::noise_is_rounding(diagnose::track_set(made.results, made.setups, true)));
    const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(made.results, made.setups, {});
    CHECK(diagnosis.none < 0.75);  // a viscous drag would do, and does not exclude air
    for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
      CHECK((effect.id == diagnose::ids::quadratic_drag || effect.id == diagnose::ids::rotational_inertia));
      if (effect.id != diagnose::ids::quadratic_drag) continue;
      ++named;
      CHECK(std::abs(effect.parameters.front().value - kDrag_kg_m) < 3.5 * effect.parameters.front().sd);
    }
  }
  CHECK(named >= 2);  // at odds of 3 to 1 to a viscous drag
}

TEST_CASE("bumper, cable and friction need something that touches the body") {
  const diagnose::Circumstances on_track{2, false, false, 2.0}, guided{2, true, false, 2.0},
      free_fall{2, true, true, 2.0};
  for (const auto& id : {diagnose::ids::end_stop, diagnose::ids::tether, diagnose::ids::load_independent_friction}) {
    const auto odds = diagnose::effect_list()[diagnose::effect_index(id)].odds;
    REQUIRE(odds != nullptr);
    CHECK(odds(on_track) == 1.0);
    CHECK(odds(guided) < odds(on_track));
    CHECK(odds(free_fall) < odds(guided));
    CHECK(odds(free_fall) > 0.0);  // a bungee, a cushion
  }
}

TEST_CASE("a fit that stopped on its way goes on to its minimum, one that is there stays") {
  const tests::MadeExperiment made = coarse_fall(2e-3, 0.0, 1e-3, 0.0, 30, 1);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit minimum = diagnose::fit_nominal(set);
  diagnose::FitPoint away = minimum.at;
  away.global[0] += 0.05;  // K
  const diagnose::MotionFit stopped = diagnose::linearise_at(set, {}, away);
  REQUIRE(stopped.cost > minimum.cost + 1.0);
  const diagnose::MovedOn moved = diagnose::moved_on(set, stopped, false);
  CHECK(moved.at_minimum);
  CHECK(moved.fit.cost == Approx(minimum.cost).margin(1e-3));
  CHECK(diagnose::moved_on(set, stopped, true).fit.cost == stopped.cost);
}
