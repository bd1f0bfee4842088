#include "diagnose/causes/cause_sequence.h"

#include <cmath>
#include <numbers>

#include "diagnose/gap/gap_sizes.h"
#include "diagnose/gap/held_out.h"
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
