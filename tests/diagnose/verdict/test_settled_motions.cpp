#include "diagnose/verdict/settled_motions.h"

#include <cmath>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/core/simulated_track.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

TEST_CASE("frames that look like a hand stay if a law explains them, however little else is left") {
  const tests::MadeEffect drag = {[](double, double, double v, double) { return -0.15 * v * std::abs(v); }};
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches({0.4}), drag, 7, 1e-4, 100, 60.0);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  diagnose::TrackSet trimmed = set;
  for (diagnose::TrackedMotion& motion : trimmed.motions) motion.t_s.erase(motion.t_s.begin(), motion.t_s.begin() + 20);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto with = [&](std::string_view id, double size) {
    const std::size_t effect = diagnose::effect_index(id);
    return diagnose::fit_with_effect(set, nominal, effect, diagnose::with_effect(set, nominal, effect, {size}, {}));
  };
  const diagnose::MotionFit fit = with(diagnose::ids::quadratic_drag, 0.1);
  CHECK(diagnose::explains_disputed(set, nominal, fit, trimmed));
  CHECK_FALSE(diagnose::explains_disputed(set, nominal, nominal, trimmed));
  CHECK_FALSE(diagnose::explains_disputed(set, nominal, with(diagnose::ids::scale_error, 0.01), trimmed));
  // A hand on the first 20 positions of each motion, 5 mm: the drag still explains the rest, and not these.
  for (diagnose::TrackedMotion& motion : set.motions) {
    for (std::size_t p = 0; p < 20; ++p) motion.x_m[p] += 0.005 * std::pow(1.0 - static_cast<double>(p) / 20.0, 2);
  }
  const diagnose::MotionFit pushed = diagnose::fit_nominal(set);
  const std::size_t effect = diagnose::effect_index(diagnose::ids::quadratic_drag);
  const diagnose::MotionFit law = diagnose::fit_motions(set, {effect}, fit.at);
  CHECK_FALSE(diagnose::explains_disputed(set, pushed, law, trimmed));
}

TEST_CASE("a recorded force of the wrong sign is told, the right one is not, nor is a force that is missing") {
  const auto push = [](double t_s) { return 0.3 * std::sin(5.0 * t_s) + 0.1 * std::sin(11.0 * t_s); };
  const auto diagnosed_with = [&](double sign) {
    tests::MadeEffect driven;
    // What acts is the push, whatever was recorded.
    driven.force = [&, sign](double, double, double, double t) { return (1.0 - sign) * push(t); };
    driven.recorded = [&, sign](double t) { return sign * push(t); };
    const std::vector<tests::MadeLaunch> launches = {{0.4, 0.0, 0.0, 0.2}, {0.6, 0.0, 0.0, 0.2}};
    const tests::MadeExperiment made = tests::made_experiment(launches, driven, 9, 2e-4, 200, 60.0, 0.1);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    return diagnose::reversed_force(set, diagnose::fit_nominal(set));
  };
  CHECK_FALSE(diagnosed_with(1.0));
  CHECK_FALSE(diagnosed_with(0.5));
  const auto wrong = diagnosed_with(-1.0);
  REQUIRE(wrong);
  CHECK(wrong->part_of_chi2 < 0.1);
}

TEST_CASE("bounces that lose speed are no spring, whatever law beside one takes part of them") {
  // A fifth of the speed is lost at a hard stop, as no spring does; 50 Hz and 1 cm, as of a motion sensor.
  const tests::Law law{2.0, 0.003, 0.02};
  for (const unsigned seed : {1U, 2U}) {
    const tests::SimulatedMotion motion = tests::SimulatedMotion(0.2).slide(law, 15.0, 1.2, 0.8);
    const core::TrackData track = tests::film(motion, {50.0, 15.0, 2e-3, seed, 0.01});
    core::ClipSetup setup = tests::clip_setup(core::Launched::released, 2.0, 0.5);
    setup.incline_sd_rad = 0.2 * 3.14159265 / 180.0;
    core::AnalysisResults results;
    results.gravity_m_s2 = tests::kGravity;
    results.clips.push_back(core::analyze_motion(setup, track, {}));
    const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(results, {setup}, {.without = {}, .jobs = 2});
    // Most of the bounces are left out; a stop that shows in what is left is one, and leaves nothing.
    REQUIRE(diagnosis.gap);
    CHECK(diagnosis.points < 600);
    if (diagnosis.verdict == diagnose::Verdict::effect) {
      const std::string& first = diagnosis.effects.front().id;
      CHECK((first == "end_stop" || first == "tether"));
      CHECK(diagnosis.gap->after < 1.2);
    } else {
      CHECK(diagnosis.verdict == diagnose::Verdict::none);
    }
    REQUIRE(diagnosis.recovered.size() == 1);
    REQUIRE(diagnosis.recovered[0].alpha_deg.estimate);
    const core::Estimate& alpha = *diagnosis.recovered[0].alpha_deg.estimate;
    CHECK(std::abs(alpha.value - 2.0) < 4.0 * alpha.sd);
  }
}
