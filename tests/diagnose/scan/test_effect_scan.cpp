#include "diagnose/scan/effect_scan.h"

#include <cmath>
#include <string_view>
#include <vector>

#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// Of a force c v |v| beside the linear drag, the scans of the drags that have one sign and of one that has both.
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
  // Of a linear neighbourhood: K takes up most of the force, and by how much changes with the motion itself.
  CHECK(braking.quadratic.values.front() == Approx(c).epsilon(0.3));
  // The same force with the other sign shows as clearly, and an effect that has one sign gains nothing by it.
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

TEST_CASE("two clips have no trend: one of them always has more friction than the other") {
  const tests::MadeLaunch up{0.4, 4.0, 0.3, -1.1}, down{0.4, 4.0, -0.6, 1.2};
  CHECK_FALSE(is_visible({up, down}, "friction_drift"));
  CHECK(is_visible({up, down, up}, "friction_drift"));
}

TEST_CASE("what falls has no track that could be bowed") {
  const tests::MadeLaunch fall{0.4, 90.0, 0.0, 0.1}, heavier{0.8, 90.0, 0.0, 0.1}, slope{0.4, 60.0, 0.0, 0.1};
  CHECK_FALSE(is_visible({fall, heavier, fall}, "track_bow"));
  CHECK(is_visible({fall, heavier, fall}, "quadratic_drag"));
  CHECK(is_visible({slope, slope, slope}, "track_bow"));
}

TEST_CASE("prior odds are those of the recording: what falls is braked by the square of the speed") {
  const tests::MadeLaunch fall{0.4, 90.0, 0.0, 0.1}, slope{0.4, 60.0, 0.0, 0.1};
  const auto odds = [](const std::vector<tests::MadeLaunch>& launches, std::string_view id) {
    const auto made = tests::made_experiment(launches, {}, 3, 5e-5, 60);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    return diagnose::prior_odds(set, diagnose::effect_index(id));
  };
  // At a Reynolds number R a sphere has a drag of 24/R (1 + R/24 0.4) or so: where R is 1000, the part that goes with
  // the square of the speed is seventeen times the other.
  CHECK(odds({fall, fall, fall}, "quadratic_drag") > odds({fall, fall, fall}, "eddy_rolloff"));
  CHECK(odds({fall, fall, fall}, "load_independent_friction") < 1.0);
  CHECK(odds({fall, fall, fall}, "track_bow") == 0.0);
  for (const std::string_view id : {"quadratic_drag", "rotational_inertia", "load_independent_friction", "track_bow"}) {
    CHECK(odds({fall, slope, slope}, id) == 1.0);
  }
  CHECK(odds({slope, slope}, "friction_drift") == 0.0);
}
