#include "diagnose/scan/effect_scan.h"

#include <cmath>
#include <string_view>
#include <vector>

#include "diagnose/fit/nominal_fit.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// For a force c v |v| beside the linear drag: the scan of an effect with one sign and that of one with both signs.
struct Scans {
  diagnose::EffectScan quadratic, asymmetry;
};

Scans scans_of(double c_n_s2_m2) {
  const tests::MadeEffect effect{
      .force = [=](double, double, double v, double) { return -c_n_s2_m2 * v * std::abs(v); }};
  const auto made = tests::made_experiment(tests::made_launches(), effect, 5, 2e-5, 100);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::ScoreSpace space(set, nominal);
  return {diagnose::scan_effect(space, diagnose::effect_index("quadratic_drag")),
          diagnose::scan_effect(space, diagnose::effect_index("direction_asymmetry"))};
}

}  // namespace

TEST_CASE("a drag that brakes is seen, and one that would drive is no drag") {
  const double c = 0.1;
  const Scans braking = scans_of(c), driving = scans_of(-c);
  REQUIRE(braking.quadratic.visible);
  CHECK(braking.quadratic.gain > 20.0);
  CHECK(braking.quadratic.log_evidence > 20.0);
  // This is a linear neighbourhood: K absorbs most of the force, and how much of it depends on the motion.
  CHECK(braking.quadratic.values.front() == Approx(c).epsilon(0.3));
  // The same force with the opposite sign shows as clearly, but an effect of one sign gains nothing by it.
  REQUIRE(driving.quadratic.visible);
  CHECK(driving.quadratic.gain == 0.0);
  CHECK(driving.quadratic.log_evidence < -1.0);
  CHECK(driving.quadratic.values.front() > 0.0);
}

namespace {

bool is_visible(const std::vector<tests::MadeLaunch>& launches, std::string_view id) {
  const auto made = tests::made_experiment(launches, {}, 3, 5e-5, 60);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  return diagnose::scan_effect(diagnose::ScoreSpace(set, nominal), diagnose::effect_index(id)).visible;
}

}  // namespace

TEST_CASE("two clips show no trend: one of them always has more friction than the other") {
  const tests::MadeLaunch up{0.4, 4.0, 0.3, -1.1}, down{0.4, 4.0, -0.6, 1.2};
  CHECK_FALSE(is_visible({up, down}, "friction_drift"));
  CHECK(is_visible({up, down, up}, "friction_drift"));
}

TEST_CASE("a second effect needs six further positions to spare") {
  const auto is_shown = [](std::size_t frames, bool beside) {
    const tests::MadeExperiment made =
        tests::made_experiment({{0.4, 90.0, 0.0, 0.1}}, {}, 3, 1e-5, frames, 30.0, 1.0, 0.0, {.mu = 0.0});
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const diagnose::MotionFit nominal = diagnose::linearise_again(set, diagnose::fit_nominal(set));
    const std::size_t lens = diagnose::effect_index(diagnose::ids::lens_distortion);
    const diagnose::FitPoint start = diagnose::with_effect(set, nominal, lens, {0.01, 0.0}, {});
    const diagnose::MotionFit fit = beside ? diagnose::fit_motions(set, {lens}, start) : nominal;
    return diagnose::scan_effect(diagnose::ScoreSpace(set, fit), diagnose::effect_index(diagnose::ids::tether)).visible;
  };
  // K, a start and a speed, two for the cable, and two for the lens.
  CHECK_FALSE(is_shown(10, false));
  CHECK(is_shown(13, false));
  CHECK_FALSE(is_shown(17, true));
  CHECK(is_shown(21, true));
}

TEST_CASE("a falling object has no track that could be bowed") {
  const tests::MadeLaunch fall{0.4, 90.0, 0.0, 0.1}, heavier{0.8, 90.0, 0.0, 0.1}, slope{0.4, 60.0, 0.0, 0.1};
  CHECK_FALSE(is_visible({fall, heavier, fall}, "track_bow"));
  CHECK(is_visible({fall, heavier, fall}, "quadratic_drag"));
  CHECK(is_visible({slope, slope, slope}, "track_bow"));
}

TEST_CASE("prior odds follow the recording: a falling object is braked by the square of the speed") {
  const tests::MadeLaunch fall{0.4, 90.0, 0.0, 0.1}, slope{0.4, 60.0, 0.0, 0.1};
  const auto odds = [](const std::vector<tests::MadeLaunch>& launches, std::string_view id) {
    const auto made = tests::made_experiment(launches, {}, 3, 5e-5, 60);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    return diagnose::prior_odds(set, diagnose::effect_index(id));
  };
  // At a Reynolds number R the drag coefficient of a sphere is about 24/R (1 + 0.4 R/24). At R = 1000, the part of the
  // drag that grows with the square of the speed is seventeen times the other.
  CHECK(odds({fall, fall, fall}, "quadratic_drag") > odds({fall, fall, fall}, "eddy_rolloff"));
  CHECK(odds({fall, fall, fall}, "load_independent_friction") < 1.0);
  CHECK(odds({fall, fall, fall}, "track_bow") == 0.0);
  for (const std::string_view id : {"quadratic_drag", "rotational_inertia", "load_independent_friction", "track_bow"}) {
    CHECK(odds({fall, slope, slope}, id) == 1.0);
  }
  CHECK(odds({slope, slope}, "friction_drift") == 0.0);
  // Under one load a friction that does not depend on it is a part of mu: cos(2 deg) and cos(4 deg) differ by 0.2 %.
  const tests::MadeLaunch low{0.4, 2.0, -0.5, 1.0}, steep{0.4, 4.0, -0.5, 1.0}, heavier{0.5, 4.0, -0.5, 1.0};
  CHECK(odds({low, steep, low}, "load_independent_friction") == 0.0);
  CHECK(odds({low, steep, heavier}, "load_independent_friction") == 1.0);
  CHECK(odds({low, slope, low}, "load_independent_friction") == 1.0);
}
