#include "diagnose/weigh/air_odds.h"

#include <cmath>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/tracks/track_set.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

// At its terminal velocity a body keeps its speed whatever moves along with it.
TEST_CASE("near its terminal velocity a body has no inertia that is too large for air, however certain it seems") {
  const double mass_kg = 1e-3, terminal_m_s = 1.7, k_n_s_m = mass_kg * 9.80665 / terminal_m_s;
  const tests::MadeExperiment made =
      tests::made_experiment({{mass_kg, 90.0, 0.0, terminal_m_s}, {mass_kg, 90.0, 0.0, terminal_m_s}}, {}, 3, 2e-3, 50,
                             60.0, 0.0, 0.0, {.k_n_s_m = k_n_s_m, .mu = 0.0});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(set.through_air);
  const std::size_t inertia = diagnose::effect_index(diagnose::ids::rotational_inertia);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto odds = [&](double added_kg) {
    const diagnose::FitPoint at = diagnose::with_effect(set, nominal, inertia, {added_kg}, {});
    return std::exp(diagnose::log_odds_without_air(set, diagnose::linearise_at(set, {inertia}, at)));
  };
  CHECK(odds(1e-3) == Approx(0.05));  // as much as the body itself, as air may
  CHECK(odds(0.05) < 1e-6);           // a disc of 0.25 m, of a body of 1 g
}

TEST_CASE("an inertia that may be larger than that of air, and may not, is neither of air nor of a wheel") {
  const tests::MadeExperiment made = tests::made_experiment({{0.05, 90.0, 0.0, 0.02, 0.0, 0.0, 1.3}}, {}, 3, 5e-3, 14,
                                                            25.0, 0.0, 0.0, {.k_n_s_m = 0.0, .mu = 0.0});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(set.through_air);
  const std::size_t inertia = diagnose::effect_index(diagnose::ids::rotational_inertia);
  diagnose::FitPoint at = diagnose::with_effect(set, diagnose::fit_nominal(set), inertia, {0.013}, {});
  at.global[0] = 0.0;
  const diagnose::MotionFit fit = diagnose::linearise_at(set, {inertia}, at);
  const auto g = static_cast<Eigen::Index>(fit.layout->first_of(inertia));
  REQUIRE(std::sqrt(diagnose::common_covariance(fit)(g, g)) > 0.001);  // 0.013 kg is less than two above 0.011
  CHECK(std::exp(diagnose::log_odds_without_air(set, fit)) == Approx(0.001));
}
