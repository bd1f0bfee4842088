#include "diagnose/single_frames/point_scatter.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kNoise = 2e-5, kJitter = 2e-4;  // at 1 m/s ten times the noise

/// Each frame taken at a time that is off by a normal deviate.
tests::MadeExperiment uneven(double jitter_s, unsigned seed, double noise_m = kNoise) {
  std::mt19937_64 random(seed + 100);
  std::normal_distribution<double> normal(0.0, 1.0);
  double last_x = 0.0, last_t = 0.0;
  const tests::MadeEffect effect{.seen = [&](double x, double t) {
    const double v = t > last_t ? (x - last_x) / (t - last_t) : 0.0;
    last_x = x;
    last_t = t;
    return x + jitter_s * v * normal(random);
  }};
  return tests::made_experiment(tests::made_launches(), effect, seed, noise_m);
}

}  // namespace

TEST_CASE("positions taken at uneven times get the noise of their speed, without any model") {
  const auto made = uneven(kJitter, 1);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(diagnose::give_fast_positions_their_noise(set, {}));
  const diagnose::MotionFit fit = diagnose::fit_nominal(set);
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const auto& motion = set.motions[i];
    CHECK(motion.sd_m == Approx(kNoise).epsilon(0.5));
    for (std::size_t p = 3; p + 3 < motion.x_m.size(); p += 10) {
      const double v = fit.motions[i].v_m_s[p];
      if (std::abs(v) > 0.3) CHECK(motion.sd_of(p) == Approx(std::hypot(kNoise, kJitter * v)).epsilon(0.25));
    }
  }
  // Chi-squared's own scatter over 1200 points is 0.04.
  double points = 0.0;
  for (const auto& motion : set.motions) points += static_cast<double>(motion.x_m.size());
  CHECK(fit.cost / points == Approx(1.0).margin(0.16));
}

TEST_CASE("even noise stays as it is, also beside a drag that the model lacks, and where a file is rounded") {
  const auto even = uneven(0.0, 2);
  diagnose::TrackSet set = diagnose::track_set(even.results, even.setups, true);
  CHECK(!diagnose::give_fast_positions_their_noise(set, {}));

  const tests::MadeEffect drag{.force = [](double, double, double v, double) { return -0.3 * v * std::abs(v); }};
  const auto more = tests::made_experiment(tests::made_launches(), drag, 2);
  set = diagnose::track_set(more.results, more.setups, true);
  CHECK(!diagnose::give_fast_positions_their_noise(set, {}));

  const tests::MadeEffect coarse{.seen = [](double x, double) { return 0.002 * std::round(x / 0.002); }};
  const auto rounded = tests::made_experiment(tests::made_launches(), coarse, 2, 0.0);
  set = diagnose::track_set(rounded.results, rounded.setups, true);
  CHECK(!diagnose::give_fast_positions_their_noise(set, {}));
}

TEST_CASE("uneven times are named alone: what they scatter is no push and no force") {
  for (const unsigned seed : {3u, 4u, 5u}) {
    const auto made = uneven(kJitter, seed);
    const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
    REQUIRE(diagnosis.effects.size() == 1);
    CHECK(diagnosis.effects.front().id == "timestamp_jitter");
    REQUIRE(diagnosis.effects.front().parameters.size() == 1);
    CHECK(diagnosis.effects.front().parameters.front().value == Approx(kJitter).epsilon(0.1));
  }
}

TEST_CASE("uneven times that hardly show are a trace, and the verdict only where they are all but certain") {
  std::size_t traces = 0, verdicts = 0;
  for (const double part : {0.06, 0.1, 0.12}) {
    for (const unsigned seed : {6u, 7u, 8u}) {
      CAPTURE(part, seed);
      const auto made = uneven(part * kJitter, seed);
      const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
      if (diagnosis.verdict == diagnose::Verdict::effect) {
        ++verdicts;
        CHECK(diagnosis.effects.front().joint_probability >= 0.9);
      } else {
        CHECK(diagnosis.verdict == diagnose::Verdict::none);
        CHECK(diagnosis.effects.empty());
        traces += std::count(diagnosis.traces.begin(), diagnosis.traces.end(), "timestamp_jitter") != 0;
      }
    }
  }
  CHECK(traces > 0);
  CHECK(verdicts > 0);
}
