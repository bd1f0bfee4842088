#include "diagnose/causes/cause_sequence.h"

#include <cmath>
#include <numbers>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/gap_sizes.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

TEST_CASE("a gap below the estimated noise is the floor, and all shares together make the excess") {
  // A camera that shakes with a period of four frames. By neighbouring positions this looks like noise, whose estimate
  // is too large by about sqrt(1 + A²/2 sd²) until the shake is in the model.
  constexpr double kSd_m = 1e-4, kAmplitude_m = 3e-4, kRate_hz = 50.0;
  tests::MadeEffect shake;
  shake.seen = [](double x, double t) {
    return x + kAmplitude_m * std::sin(2.0 * std::numbers::pi * 0.2531 * kRate_hz * t);
  };
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), shake, 21, kSd_m, 80, kRate_hz);
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(made.results, made.setups, {});
  REQUIRE(diagnosis.gap);
  REQUIRE(diagnosis.gap->floor < 0.7);
  CHECK(diagnosis.gap->floor == diagnosis.gap->after);
  REQUIRE_FALSE(diagnosis.explained.empty());
  double sum = 0.0;
  for (const diagnose::ExplainedCause& cause : diagnosis.explained) {
    CHECK(cause.share > 0.0);
    sum += cause.share;
    // Eight clips: a jackknife over them, about the share.
    REQUIRE(cause.share_interval95);
    CHECK(cause.share_interval95->low < cause.share);
    CHECK(cause.share_interval95->high >= cause.share);
  }
  CHECK(sum == Approx(1.0).epsilon(1e-9));
  REQUIRE(diagnosis.gap->shrink);
  CHECK(*diagnosis.gap->shrink == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("the floor is 1 unless a gap lies clearly below it") {
  CHECK(diagnose::floor_of(0.96, 0.01) == 1.0);
  CHECK(diagnose::floor_of(1.2, 0.01) == 1.0);
  CHECK(diagnose::floor_of(0.95, 0.01) == 0.95);
}

TEST_CASE(
    "recordings that lack nothing have no gap at the bound of a clear gap, and some have at two standard errors") {
  const std::vector<tests::MadeLaunch> launches = {{0.4, 4.0, 0.3, -1.1}, {0.4, 4.0, -0.6, 1.2}, {0.5, 4.0, 0.3, -1.0}};
  constexpr unsigned kRecordings = 60;
  int clear = 0, beyond_two = 0;
  for (unsigned seed = 1; seed <= kRecordings; ++seed) {
    // Noise that is slightly correlated between neighbouring positions, as that of any tracker.
    const auto made = tests::made_experiment(launches, {}, seed, 2e-4, 40, 50.0, 0.05, 0.15);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
    const diagnose::HeldOutGap gap = diagnose::held_out_gap(set, nominal);
    clear += diagnose::has_gap(set, nominal) ? 1 : 0;
    beyond_two += gap.value > 1.0 + 2.0 * gap.standard_error ? 1 : 0;
  }
  CHECK(clear == 0);
  CHECK(beyond_two > 0);
}

TEST_CASE("the share of a hand is that of the hand beside the law, not of one that follows what the law does") {
  // Friction that grows by 2.5 % from clip to clip, and a hand that pushes for the first 80 ms.
  std::size_t clip = 0;
  double before = 1.0;
  tests::MadeEffect both;
  both.force = [&](double m, double, double v, double t) {
    if (t < before - 0.1) ++clip;
    before = t;
    const double more = 0.025 * (static_cast<double>(clip) - 3.5) * 0.02 * m * 9.80665;
    return (v > 0.0 ? -more : v < 0.0 ? more : 0.0) + (t < 0.08 ? 2.4 * m * (clip % 2 == 0 ? 1.0 : -0.7) : 0.0);
  };
  std::vector<tests::MadeLaunch> launches;
  for (int c = 0; c < 6; ++c) launches.push_back({0.4, 4.0, c % 2 == 0 ? 0.3 : -0.6, c % 2 == 0 ? -1.1 : 0.6});
  const tests::MadeExperiment made =
      tests::made_experiment(launches, both, 3, 5e-5, 150, 100.0, 0.05, 0.0, {.k_n_s_m = 0.2, .mu = 0.02});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto with = [&](const diagnose::MotionFit& fit, const char* id) {
    const std::size_t effect = diagnose::effect_index(id);
    const diagnose::EffectScan scan = diagnose::scan_effect(diagnose::ScoreSpace(set, fit), effect);
    REQUIRE_FALSE(scan.values.empty());
    return diagnose::fit_with_effect(set, fit, effect, diagnose::with_effect(set, fit, effect, scan.values, scan.own));
  };
  const diagnose::MotionFit named = with(with(nominal, "friction_drift"), "late_release");
  const diagnose::MotionFit hand = with(nominal, "late_release");
  const auto until_of = [](const diagnose::MotionFit& fit) {
    return static_cast<Eigen::Index>(fit.layout->first_of(diagnose::effect_index("late_release")));
  };
  const double until = named.at.global[until_of(named)];
  CHECK(until == Approx(0.08).margin(0.02));
  diagnose::FitPoint start = hand.at;
  start.global[until_of(hand)] = until;
  const diagnose::MotionFit held =
      diagnose::fit_held(set, hand.effects, start, {}, {static_cast<std::size_t>(until_of(hand))});
  CHECK(held.at.global[until_of(held)] == Approx(until).margin(1e-6));
  const double before_all = diagnose::held_out_excess(set, nominal);
  const double by_hand = 1.0 - diagnose::held_out_excess(set, held) / before_all;
  // A hand by itself pushes for longer, and takes part of what the drift explains.
  CHECK(hand.at.global[until_of(hand)] > until);
  CHECK(1.0 - diagnose::held_out_excess(set, hand) / before_all > by_hand + 0.002);
  const diagnose::CauseSequence sequence = diagnose::sequence_of(set, nominal, set, named, {}, 0.02);
  double told = 0.0;
  for (const diagnose::ExplainedCause& cause : sequence.causes) told += cause.id == "late_release" ? cause.share : 0.0;
  REQUIRE(sequence.causes.size() >= 2);
  CHECK(sequence.causes.front().id == "late_release");
  CHECK(told == Approx(by_hand).margin(1e-3));  // the floor may lie a little below 1
}
