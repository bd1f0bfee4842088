#include "diagnose/weigh/fit_odds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

TEST_CASE("a scale or a clock that is far off is rarer than one that is nearly right, and other sizes are not") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 3);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  CHECK(diagnose::log_odds_of_sizes(nominal) == 0.0);
  const auto log_odds = [&](std::string_view id, double size) {
    const std::size_t effect = diagnose::effect_index(id);
    diagnose::MotionFit fit =
        diagnose::fit_with_effect(set, nominal, effect, diagnose::with_effect(set, nominal, effect, {1e-4}, {}));
    fit.at.global[static_cast<Eigen::Index>(fit.layout->first_of(effect))] = size;
    return diagnose::log_odds_of_sizes(fit);
  };
  for (const std::string_view id : {diagnose::ids::scale_error, diagnose::ids::frame_rate_error}) {
    CHECK(log_odds(id, 0.0) == 0.0);
    CHECK(log_odds(id, 0.1) == Approx(-std::log(2.0)));  // a tenth is the usual size
    CHECK(log_odds(id, -0.3) == Approx(-std::log(10.0)));
  }
  CHECK(log_odds(diagnose::ids::late_release, 0.1) == Approx(-std::log(1.25)));  // two tenths of a second are usual
  CHECK(log_odds(diagnose::ids::late_release, 0.4) == Approx(-std::log(5.0)));
  CHECK(log_odds(diagnose::ids::quadratic_drag, 0.3) == 0.0);
}

TEST_CASE("a bumper or a cable that touches everywhere or nowhere is at the end of its range") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 3);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::ParameterRange places = diagnose::range_of_places(set);
  for (const std::string_view id : {diagnose::ids::tether, diagnose::ids::end_stop}) {
    const std::size_t effect = diagnose::effect_index(id);
    const auto ends = [&](double place_m) {
      const diagnose::FitPoint at = diagnose::with_effect(set, nominal, effect, {0.01, place_m}, {});
      return diagnose::effects_at_end(diagnose::linearise_at(set, {effect}, at));
    };
    CHECK(ends(places.low) == std::vector<std::size_t>{effect});
    CHECK(ends(places.high) == std::vector<std::size_t>{effect});
    CHECK(ends(0.3 * places.low + 0.7 * places.high).empty());
  }
}

TEST_CASE("the axis of a lens is rarer at an end of the motion than in its middle") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 3);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  double low = 1e9, high = -1e9;
  for (const diagnose::TrackedMotion& motion : set.motions) {
    for (const double x : motion.x_m) low = std::min(low, x), high = std::max(high, x);
  }
  const std::size_t lens = diagnose::effect_index(diagnose::ids::lens_distortion);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto log_odds = [&](double axis_m) {
    diagnose::FitPoint at = diagnose::with_effect(set, nominal, lens, {0.01, axis_m}, {});
    return diagnose::log_odds_of_sizes(diagnose::linearise_at(set, {lens}, at));
  };
  CHECK(log_odds(0.5 * (low + high)) == Approx(0.0).margin(1e-12));
  CHECK(log_odds(low + 0.25 * (high - low)) == Approx(-std::log(2.0)));
  CHECK(log_odds(high) == Approx(-std::log(5.0)));
}

TEST_CASE("a bumper stands in the outer quarter at either end, a cable tightens anywhere") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 3);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::ParameterRange x = diagnose::range_of_places(set);
  const auto log_odds = [&](std::string_view id, double part) {
    const std::size_t effect = diagnose::effect_index(id);
    const double place_m = x.low + part * (x.high - x.low);
    diagnose::Comparison comparison;
    comparison.fits = {
        diagnose::linearise_at(set, {effect}, diagnose::with_effect(set, nominal, effect, {1.0, place_m}, {}))};
    diagnose::set_fit_odds(set, comparison);
    return comparison.fit_odds.front();
  };
  // At the very ends it touches always or never.
  for (const double part : {0.05, 0.1, 0.24, 0.76, 0.9, 0.95}) CHECK(log_odds(diagnose::ids::end_stop, part) == 0.0);
  for (const double part : {0.3, 0.4, 0.5, 0.6, 0.7}) {
    CHECK(log_odds(diagnose::ids::end_stop, part) == Approx(-std::log(1000.0)));
  }
  for (const double part : {0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 0.95}) CHECK(log_odds(diagnose::ids::tether, part) == 0.0);
}
