#include "report/text/display_text.h"

#include "tests/catch.h"
#include "tests/report/made_results.h"

using namespace glidelab;

TEST_CASE(
    "a configuration is called by mass and inclination, and by its group where these do not tell it from another") {
  core::AnalysisResults results = tests::made_results();
  results.configurations.resize(1);
  results.configurations[0].mass_kg = 0.5;
  results.configurations[0].incline_deg = 2.0;
  results.configurations[0].group = "plunger";
  CHECK(report::configuration_name(results, results.configurations[0]) == "0.5 kg, 2°");
  results.configurations.push_back(results.configurations[0]);
  CHECK(report::configuration_name(results, results.configurations[0]) == "0.5 kg, 2°, plunger");
}
