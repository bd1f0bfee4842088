#include "diagnose/verdict/fit_given_causes.h"

#include <cmath>
#include <string>
#include <vector>

#include "base/errors.h"
#include "core/motion/configurations.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/diagnose/scattering_friction.h"

using namespace glidelab;

namespace {

constexpr double kDrag_kg_m = 0.08;

/// Two masses, level and inclined, with a drag that grows with the square of the speed.
tests::MadeExperiment with_drag(unsigned seed) {
  tests::MadeEffect drag;
  drag.force = [](double, double, double v, double) { return -kDrag_kg_m * v * std::abs(v); };
  return tests::made_experiment(tests::made_launches(), drag, seed);
}

diagnose::GivenCauses fit(const tests::MadeExperiment& made, const std::vector<std::string>& ids) {
  return diagnose::fit_given_causes(
      made.results, made.setups, std::vector<std::optional<core::CameraSettings>>(made.setups.size()), ids, "--with");
}

std::string refusal(const tests::MadeExperiment& made, const std::vector<std::string>& ids) {
  try {
    fit(made, ids);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "none";
}

bool holds(const core::Quantity& quantity, double truth) {
  return quantity.estimate && quantity.estimate->low95 <= truth && truth <= quantity.estimate->high95;
}

}  // namespace

TEST_CASE("with the acting drag in the model, K/m, mu and its size hold the truth that the nominal model misses") {
  const tests::MadeGlider truth;
  int intervals = 0, held = 0;
  for (const unsigned seed : {11u, 12u, 13u, 14u}) {
    const tests::MadeExperiment made = with_drag(seed);
    const diagnose::GivenCauses given = fit(made, {"quadratic_drag"});
    REQUIRE(given.recovered.size() == 4);
    for (const diagnose::RecoveredConfiguration& of : given.recovered) {
      REQUIRE(of.with == std::vector<std::string>{"quadratic_drag"});
      held += holds(of.k_over_m_1_s, truth.k_n_s_m / of.mass_kg) + holds(of.mu, truth.mu) +
              holds(of.alpha_deg, of.incline_deg);
      intervals += 3;
    }
    REQUIRE(given.causes.size() == 1);
    REQUIRE(given.causes[0].parameters.size() == 1);
    const diagnose::DiagnosedParameter& size = given.causes[0].parameters[0];
    CHECK(size.key == "c_kg_m");
    CHECK(std::abs(size.value - kDrag_kg_m) < 4.0 * size.sd);
    CHECK(size.sd < 0.02 * kDrag_kg_m);  // otherwise the test would say nothing
    CHECK(given.gap_before > 10.0);
    CHECK(given.gap_after < 1.2);
    CHECK(given.converged);
    // The nominal model is off by many of its own standard deviations.
    const auto alone = core::configurations_of_clips(made.setups, made.results.clips, truth.gravity_m_s2);
    REQUIRE(alone.size() == 4);
    for (const core::ConfigurationResult& of : alone) {
      if (of.incline_deg < 1.0) continue;
      REQUIRE(of.k_over_m_1_s.estimate);
      const double off = of.k_over_m_1_s.estimate->value - truth.k_n_s_m / of.mass_kg;
      CHECK(off > 5.0 * of.k_over_m_1_s.estimate->sd);
    }
  }
  // Of 48 intervals of 95 %, few of them independent, 2.4 miss on average; 10 is four times as many.
  CHECK(held >= intervals - 10);
}

TEST_CASE("a diagnosis that is certain of a cause recovers the same as the fit with that cause given") {
  const tests::MadeExperiment made = with_drag(3);
  const diagnose::GivenCauses given = fit(made, {"quadratic_drag"});
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(made.results, made.setups, {});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  REQUIRE(diagnosis.recovered.size() == given.recovered.size());
  for (std::size_t c = 0; c < given.recovered.size(); ++c) {
    const diagnose::RecoveredConfiguration &one = given.recovered[c], &other = diagnosis.recovered[c];
    REQUIRE(one.with == other.with);
    CHECK(one.group == other.group);
    CHECK(one.mass_kg == other.mass_kg);
    for (const auto quantity : {&diagnose::RecoveredConfiguration::k_over_m_1_s, &diagnose::RecoveredConfiguration::mu,
                                &diagnose::RecoveredConfiguration::alpha_deg}) {
      REQUIRE((one.*quantity).estimate);
      REQUIRE((other.*quantity).estimate);
      // Two paths to one minimum. Each ends when chi² changes by less than 1e-3, which is 0.03 standard deviations.
      CHECK(std::abs((one.*quantity).estimate->value - (other.*quantity).estimate->value) <
            0.03 * (one.*quantity).estimate->sd);
      // The diagnosis widens intervals by other likely explanations, and never narrows them.
      CHECK((other.*quantity).estimate->sd > 0.97 * (one.*quantity).estimate->sd);
    }
  }
}

TEST_CASE("two causes are fitted together, whatever the order in which they are named") {
  const double inertia_kg = 0.02;
  std::vector<tests::MadeLaunch> launches = tests::made_launches();
  for (tests::MadeLaunch& launch : launches) launch.inertia = 1.0 + inertia_kg / launch.mass_kg;
  tests::MadeEffect drag;
  drag.force = [](double, double, double v, double) { return -kDrag_kg_m * v * std::abs(v); };
  const tests::MadeExperiment made = tests::made_experiment(launches, drag, 21);
  const diagnose::GivenCauses one = fit(made, {"quadratic_drag", "rotational_inertia"});
  const diagnose::GivenCauses other = fit(made, {"rotational_inertia", "quadratic_drag"});
  REQUIRE(one.causes.size() == 2);
  CHECK(one.causes[0].id == "quadratic_drag");
  CHECK(other.causes[0].id == "rotational_inertia");
  const diagnose::DiagnosedParameter &c = one.causes[0].parameters[0], &m_w = one.causes[1].parameters[0];
  CHECK(std::abs(c.value - kDrag_kg_m) < 4.0 * c.sd);
  CHECK(std::abs(m_w.value - inertia_kg) < 4.0 * m_w.sd);
  CHECK(other.causes[1].parameters[0].value == Approx(c.value).margin(0.03 * c.sd));
  CHECK(other.causes[0].parameters[0].value == Approx(m_w.value).margin(0.03 * m_w.sd));
}

TEST_CASE("a cause that does not act has a size of 0, and the gap stays") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 5);
  const diagnose::GivenCauses given = fit(made, {"track_bow"});
  REQUIRE_FALSE(given.causes[0].parameters.empty());
  const diagnose::DiagnosedParameter& slope = given.causes[0].parameters[0];
  CHECK(std::abs(slope.value) < 4.0 * slope.sd);
  CHECK(std::abs(given.gap_before - given.gap_after) < 3.0 * given.standard_error);
}

TEST_CASE("an effect that no fit or no such recording can show is refused, with a list of those that can be named") {
  const tests::MadeExperiment made = with_drag(7);
  const auto says = [](const std::string& text, const std::string& part) {
    INFO(text);
    return text.find(part) != std::string::npos;
  };
  const std::string unknown = refusal(made, {"quadratic_darg"});
  CHECK(says(unknown, "quadratic_darg"));
  CHECK(says(unknown, "did you mean \"quadratic_drag\"?"));
  CHECK(says(unknown, "rotational_inertia"));
  const std::string of_images = refusal(made, {"exposure_blur"});
  CHECK(says(of_images, "which no fit of a motion can hold"));
  CHECK(says(of_images, "one of quadratic_drag"));
  const std::string of_rows = refusal(made, {"rolling_shutter"});
  CHECK(says(of_rows, "tracks without images"));
  CHECK(says(of_rows, "one that they can show: quadratic_drag"));
  CHECK_FALSE(says(of_rows.substr(of_rows.find("can show: ")), "rolling_shutter"));
  CHECK(says(refusal(made, {"tether", "tether"}), "\"tether\" twice"));
  const std::string of_force = refusal(made, {"force_gain"});
  CHECK(says(of_force, "force_gain"));
  CHECK(says(of_force, "one that they can show"));
  CHECK(refusal(made, {"quadratic_drag"}) == "none");
}

TEST_CASE("a bumper that is given keeps its frames, although friction scatters and no fit reaches the noise") {
  const auto made = tests::made_with_bumper();
  const diagnose::GivenCauses given = fit(made, {"end_stop"});
  REQUIRE(given.causes.size() == 1);
  REQUIRE(given.causes[0].parameters.size() == 2);
  CHECK(given.causes[0].parameters[0].value == Approx(25.0).epsilon(0.03));
  CHECK(given.causes[0].parameters[1].value == Approx(0.35).margin(5e-3));
}
