#include "diagnose/fit/integrated_start.h"

#include <cmath>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kDeg = 3.14159265358979 / 180.0;

/// One run up an incline of a degree and back, 7.5 s at 40 Hz, whose inclination nobody states.
diagnose::TrackSet long_run(const tests::MadeGlider& glider, const tests::MadeEffect& effect, double noise_m) {
  const std::vector<tests::MadeLaunch> launches = {{1.0, 1.0, 1.3, -0.55}};
  tests::MadeExperiment made = tests::made_experiment(launches, effect, 11, noise_m, 300, 40.0, 0.0, 0.0, glider);
  for (core::ClipSetup& setup : made.setups) setup.incline_rad = 0.0;
  return diagnose::track_set(made.results, made.setups, true);
}

}  // namespace

TEST_CASE("integrated positions give K, mu and the inclination of a long run, wherever the statement is") {
  const diagnose::TrackSet set = long_run({.k_n_s_m = 0.08, .mu = 0.003}, {}, 1e-4);
  REQUIRE(set.motions.size() == 1);
  const diagnose::FitPoint start = diagnose::integrated_start(set);
  // The noise of 0.1 mm over 300 points; the turn is known to a frame, 25 ms of 7.5 s, and mu to 2 % by that.
  CHECK(start.global[0] == Approx(0.08).epsilon(0.05));
  CHECK(start.global[1] == Approx(0.003).epsilon(0.05));
  CHECK(start.global[2] == Approx(1.0 * kDeg).epsilon(0.01));
  CHECK(start.own[0][0] == Approx(1.3).margin(1e-3));
  CHECK(start.own[0][1] == Approx(-0.55).margin(2e-3));
}

TEST_CASE("where friction would have to drive the glider, the start has none") {
  // A push along the motion, 0.02 m/s²: mu of -0.002 and K below zero would fit it.
  const tests::MadeEffect push{
      .force = [](double m, double, double v, double) { return (v > 0.0 ? 0.02 : -0.02) * m; }};
  const diagnose::FitPoint start = diagnose::integrated_start(long_run({.k_n_s_m = 0.0, .mu = 0.0}, push, 1e-4));
  CHECK(start.global[0] >= 0.0);
  CHECK(start.global[1] == 0.0);
}

TEST_CASE("the nominal fit of a long run under another law is no worse than one from the truth") {
  // A bowed track: the slope changes by 0.15 m/s² in a metre. From the stated 0 degrees the fit ended a hundred times
  // as far off.
  const tests::MadeEffect bow{.force = [](double m, double x, double, double) { return -0.15 * m * (x - 0.7); }};
  const diagnose::TrackSet set = long_run({.k_n_s_m = 0.08, .mu = 0.003}, bow, 2.5e-4);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  diagnose::FitPoint truth = nominal.at;
  truth.global.setZero();
  truth.global.head(3) << 0.08, 0.003, 1.0 * kDeg;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    truth.own[i] << set.motions[i].x_m.front(),
        (set.motions[i].x_m[8] - set.motions[i].x_m[0]) / (set.motions[i].t_s[8] - set.motions[i].t_s[0]);
  }
  const diagnose::MotionFit from_truth = diagnose::fit_motions(set, {}, truth);
  INFO(nominal.cost << " and " << from_truth.cost);
  CHECK(nominal.cost <= 1.001 * from_truth.cost);
}

TEST_CASE("integrated positions show where a bumper begins and how stiff it is, however far the nominal fit is off") {
  // Down an incline against a spring of 30 N/m at 0.9 m, and back: m w² = k with w of about 10/s, far from any fit
  // without it.
  constexpr double kStiff_n_m = 30.0, kPlace_m = 0.9;
  const tests::MadeEffect bumper{
      .force = [](double, double x, double, double) { return x > kPlace_m ? -kStiff_n_m * (x - kPlace_m) : 0.0; }};
  const std::vector<tests::MadeLaunch> launches = {{0.3, 2.0, 0.2, 0.3}, {0.5, 2.0, 0.4, 0.2}, {0.3, 2.0, 0.8, -0.5}};
  const tests::MadeExperiment made =
      tests::made_experiment(launches, bumper, 12, 2e-4, 200, 60.0, 0.1, 0.0, {.k_n_s_m = 0.1, .mu = 0.004});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  for (const auto& id : {diagnose::ids::end_stop, diagnose::ids::tether}) {
    const std::size_t effect = diagnose::effect_index(id);
    REQUIRE(diagnose::has_integrated_start(effect));
    const auto start = diagnose::integrated_start(set, effect);
    REQUIRE(start);
    const Eigen::Index size = start->global.size() - 2;
    CHECK(start->global[size] == Approx(kStiff_n_m).epsilon(0.05));
    CHECK(start->global[size + 1] == Approx(kPlace_m).margin(2e-3));
    const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
    const diagnose::MotionFit fit =
        diagnose::fit_with_effect(set, nominal, effect, diagnose::with_effect(set, nominal, effect, {1.0, 0.5}, {}));
    CHECK_FALSE(diagnose::is_misfit(set, fit));
    CHECK(fit.at.global[size] == Approx(kStiff_n_m).epsilon(0.01));
  }
  const std::size_t bow = diagnose::effect_index(diagnose::ids::track_bow);
  CHECK_FALSE(diagnose::has_integrated_start(bow));
  CHECK_FALSE(diagnose::integrated_start(set, bow));
  // Without a bumper, no place is better by more than the positions' errors allow: K and the fit are those without one.
  const tests::MadeExperiment free =
      tests::made_experiment(launches, {}, 12, 2e-4, 60, 60.0, 0.1, 0.0, {.k_n_s_m = 0.1, .mu = 0.004});
  const diagnose::TrackSet none = diagnose::track_set(free.results, free.setups, true);
  const std::size_t stop = diagnose::effect_index(diagnose::ids::end_stop);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(none);
  CHECK_FALSE(diagnose::is_misfit(none, nominal));
  const diagnose::MotionFit with =
      diagnose::fit_with_effect(none, nominal, stop, diagnose::with_effect(none, nominal, stop, {1.0, 0.8}, {}));
  CHECK(with.cost <= nominal.cost + 1e-6);
  CHECK(with.cost > nominal.cost - 20.0);
}
