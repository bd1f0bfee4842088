#include <algorithm>
#include <cmath>

#include "diagnose/next/plan.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

const tests::MadeEffect kDrag = {[](double, double, double v, double) { return -0.05 * v * std::abs(v); }, {}};

const diagnose::PlannedEffect& effect_of(const diagnose::Plan& plan, const std::string& id) {
  return *std::find_if(plan.effects.begin(), plan.effects.end(), [&](const auto& e) { return e.id == id; });
}

}  // namespace

TEST_CASE("a plan knows an effect's standard deviation before the effect is there") {
  const auto nominal = tests::made_experiment(tests::made_launches(), {}, 3);
  const diagnose::Plan plan = diagnose::plan_of(nominal.results, nominal.setups);
  const auto& drag = effect_of(plan, "quadratic_drag");
  REQUIRE(drag.seen);
  const auto with = tests::made_experiment(tests::made_launches(), kDrag, 11);
  const auto diagnosis = diagnose::diagnose_results(with.results, with.setups, {.without = {}, .jobs = 2});
  REQUIRE(diagnosis.effects.front().id == "quadratic_drag");
  // Four standard deviations. The drag slows the glider and so changes what the data know of it: by some 10 %, as the
  // speeds at the end of the clips do; the noise is known to 3 %.
  CHECK(std::abs(drag.seen_from / (4.0 * diagnosis.effects.front().parameters.front().sd) - 1.0) < 0.25);
}

TEST_CASE("a plan counts no effect that a diagnosis of so many clips cannot name") {
  const auto made = tests::made_experiment(tests::made_launches(), {}, 3);
  REQUIRE(made.setups.size() >= 3);
  CHECK(effect_of(diagnose::plan_of(made.results, made.setups), "friction_drift").seen);
  auto two = made.results;
  two.clips.resize(2);
  const std::vector<core::ClipSetup> setups(made.setups.begin(), made.setups.begin() + 2);
  const diagnose::Plan plan = diagnose::plan_of(two, setups);
  CHECK_FALSE(effect_of(plan, "friction_drift").seen);  // of two clips one always has more friction
  CHECK(std::find(plan.isolability.ids.begin(), plan.isolability.ids.end(), "friction_drift") ==
        plan.isolability.ids.end());
}

TEST_CASE("a plan says what will look the same, and what one mass cannot show") {
  const auto made = tests::made_experiment(tests::made_launches({0.4}), {}, 3);
  const diagnose::Plan plan = diagnose::plan_of(made.results, made.setups);
  const auto& alike = effect_of(plan, "scale_error").alike;
  CHECK(std::find(alike.begin(), alike.end(), "frame_rate_error") != alike.end());
  // With one mass a friction that does not depend on the load is mu, but for the cosine of 4 degrees.
  const auto two = tests::made_experiment(tests::made_launches(), {}, 3);
  const auto& of_one = effect_of(plan, "load_independent_friction");
  const diagnose::Plan plan_of_both = diagnose::plan_of(two.results, two.setups);
  const auto& of_two = effect_of(plan_of_both, "load_independent_friction");
  CHECK(of_two.seen);
  CHECK((!of_one.seen || of_one.seen_from > 20.0 * of_two.seen_from));
}
