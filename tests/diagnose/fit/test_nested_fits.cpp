#include <algorithm>
#include <cmath>
#include <random>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// Two clips in which little of the list fits: the track has a kink in it that pulls hard, and the positions jump.
tests::MadeExperiment strange_motions(unsigned seed) {
  const tests::MadeEffect kink{.force = [](double, double x, double, double) { return x > 0.0 ? -0.6 : 0.5; },
                               .seen = [](double x, double t) { return x + (std::fmod(t, 0.37) < 0.1 ? 0.01 : 0.0); }};
  return tests::made_experiment({{0.335, 4.0, 0.3, -1.1}, {0.535, 4.0, -0.6, 1.2}, {0.535, 4.0, 0.2, -0.9}}, kink, seed,
                                3e-5, 60, 60.0);
}

}  // namespace

TEST_CASE("a fit with one more effect ends no worse than without it, from wherever it starts") {
  const tests::MadeExperiment made = strange_motions(3);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  std::size_t led_away = 0;
  for (const char* id : {"quadratic_drag", "tether", "stribeck", "base_vibration", "track_bow", "perspective_error"}) {
    CAPTURE(id);
    const std::size_t effect = diagnose::effect_index(id);
    // As far out as the effect's parameters go.
    std::vector<double> values;
    for (const diagnose::EffectParameter& parameter : diagnose::effect_list()[effect].parameters) {
      const diagnose::ParameterRange range = diagnose::range_of(set, parameter);
      if (parameter.each == diagnose::Each::experiment)
        values.push_back(values.empty() ? 0.9 * range.high : 0.5 * (range.low + range.high));
    }
    const diagnose::FitPoint start = diagnose::with_effect(set, nominal, effect, values, {});
    led_away += !(diagnose::fit_motions(set, {effect}, start).cost <= nominal.cost) ? 1 : 0;
    // The model with the effect absent is the nominal one, bit by bit but for the order of sums.
    CHECK(diagnose::fit_with_effect(set, nominal, effect, start).cost <= nominal.cost * (1.0 + 1e-9));
  }
  CHECK(led_away > 0);  // else this tests nothing
}

TEST_CASE("no explanation that was fitted gains less than nothing, and each says whether its fit came to an end") {
  const tests::MadeExperiment made = strange_motions(4);
  const diagnose::Diagnosis diagnosis =
      diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  REQUIRE_FALSE(diagnosis.ranking.empty());
  for (const diagnose::RankedExplanation& ranked : diagnosis.ranking) {
    if (ranked.left_out) continue;
    CAPTURE(ranked.explanation.effects);
    // chi² of some 1e5 to 1e7, to the rounding of its sums.
    CHECK(ranked.log_likelihood_gain >= -1e-3);
  }
}

TEST_CASE("beside a K with which the motion cannot be followed, its derivative is that towards the smaller one") {
  const tests::MadeExperiment made = tests::made_experiment({{0.4, 4.0, 0.3, -1.1}, {0.4, 4.0, -0.6, 1.2}}, {}, 3);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto at_k = [&](double k_n_s_m) {
    diagnose::FitPoint at = nominal.at;
    at.global[0] = k_n_s_m;
    return at;
  };
  // The largest K that the integrator follows: with a larger one a motion takes too many steps.
  double low = 1.0, high = 1e6;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (std::isfinite(diagnose::linearise_at(set, {}, at_k(middle)).cost) ? low : high) = middle;
  }
  REQUIRE(std::isfinite(diagnose::linearise_at(set, {}, at_k(low)).cost));
  REQUIRE_FALSE(std::isfinite(diagnose::linearise_at(set, {}, at_k(1.001 * low)).cost));
  const diagnose::MotionFit edge = diagnose::linearise_at(set, {}, at_k(low));
  const diagnose::MotionFit near = diagnose::linearise_at(set, {}, at_k(0.99 * low));
  for (std::size_t m = 0; m < edge.motions.size(); ++m) {
    CHECK(edge.motions[m].global.allFinite());
    CHECK(edge.motions[m].own.allFinite());
    // x changes with K as 1/K², so that derivatives 1 % apart differ by 2 %.
    const double size = near.motions[m].global.col(0).norm();
    CHECK((edge.motions[m].global.col(0) - near.motions[m].global.col(0)).norm() < 0.05 * size);
  }
  CHECK_NOTHROW(diagnose::ScoreSpace(set, edge));
}

TEST_CASE("derivatives beside which a motion runs off overflow in no square") {
  // Where the drag drives 0.335 kg with K = -33 N s/m, what is off by 1 m/s is off by 10^257 as much after 6 s.
  const tests::MadeExperiment made =
      tests::made_experiment({{0.335, 0.0, 0.0, 0.3}}, {}, 5, 1e-4, 150, 25.0, 0.05, 0.0, {.k_n_s_m = 0.0, .mu = 0.0});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  diagnose::FitPoint at = diagnose::fit_nominal(set).at;
  at.global.setZero();
  at.global[0] = -33.0;
  at.own[0] = Eigen::Vector2d(0.1, 0.0);  // at rest, and it stays there
  const diagnose::MotionFit fit = diagnose::linearise_at(set, {}, at);
  for (const diagnose::FitMotion& motion : fit.motions) {
    CHECK(motion.global.squaredNorm() < 1e300);
    CHECK(motion.own.squaredNorm() < 1e300);
  }
  CHECK_NOTHROW(diagnose::ScoreSpace(set, fit));
}
