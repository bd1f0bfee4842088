#include <algorithm>
#include <string>
#include <vector>

#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

TEST_CASE("what holds a body at the downhill end is a cable or a bumper, and both are said") {
  // A force beyond 0.55 m, reached in every clip: nothing in the positions tells the two apart.
  for (const double k_n_m : {6.0, 40.0}) {
    CAPTURE(k_n_m);
    tests::MadeEffect held;
    held.force = [=](double, double x, double, double) { return x > 0.55 ? -k_n_m * (x - 0.55) : 0.0; };
    const std::vector<tests::MadeLaunch> launches = {
        {0.4, 4.0, -0.3, 0.5}, {0.4, 4.0, -0.2, 0.6}, {0.4, 4.0, -0.1, 0.5}, {0.4, 4.0, -0.35, 0.7}};
    const tests::MadeExperiment made = tests::made_experiment(launches, held, 3, 1e-4, 130, 60.0);
    const diagnose::Diagnosis diagnosis =
        diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    REQUIRE_FALSE(diagnosis.effects.empty());
    const diagnose::DiagnosedEffect& first = diagnosis.effects.front();
    const std::string twin = first.id == "tether" ? "end_stop" : "tether";
    CHECK((first.id == "tether" || first.id == "end_stop"));
    CHECK(std::find(first.equivalent_to.begin(), first.equivalent_to.end(), twin) != first.equivalent_to.end());
  }
}
