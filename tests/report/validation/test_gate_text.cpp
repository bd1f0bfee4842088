#include "report/validation/gate_text.h"

#include <nlohmann/json.hpp>

#include "tests/catch.h"

using namespace glidelab;
using nlohmann::json;

namespace {

/// One quantity that has become worse, and one without an answer.
validate::Gate made() {
  validate::Gate gate;
  gate.now = {"text", 2e-5, 40, 6, {}, {}};
  gate.now.records = {{"m1", "mine", "k_over_m_1_s", 40, 39, 37, 0.01, 0.2, 0.15, 0.12, 0.5},
                      {"m1", "mine", "mu", 40, 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0}};
  return gate;
}

validate::Gate worse() {
  validate::Gate gate = made();
  gate.then = gate.now;
  gate.comparison.emplace();
  gate.comparison->tests = 8;
  gate.comparison->worse = {{"m1", "mine", "k_over_m_1_s", "spread", 0.1, 0.2, 1e-5}};
  gate.detectable = {{"m1", "mine", "k_over_m_1_s", 1.6, 0.1, 60, 3000}, {"m1", "mine", "mu", {}, {}, 90, 4000}};
  return gate;
}

}  // namespace

TEST_CASE("a gate without a baseline has the errors, null where there are none, and no verdict") {
  const json document = json::parse(report::gate_json(made()));
  CHECK(document.at("runs") == 40);
  CHECK(document.at("seed") == 6);
  CHECK_FALSE(document.contains("passed"));
  const json& k = document.at("errors").at(0);
  CHECK(k.at("answered") == 39);
  CHECK(k.at("bias") == 0.01);
  CHECK(k.at("efficiency") == 0.5);
  const json& mu = document.at("errors").at(1);
  for (const char* key : {"bias", "sd", "efficiency"}) CHECK(mu.at(key).is_null());
  CHECK(report::gate_text(made()) == report::errors_table(made().now));
}

TEST_CASE("a gate that finds something worse says so first, and how little it would have found") {
  const json document = json::parse(report::gate_json(worse()));
  CHECK(document.at("passed") == false);
  CHECK(document.at("tests") == 8);
  CHECK(document.at("worse").at(0).at("what") == "spread");
  CHECK(document.at("worse").at(0).at("p_value") == 1e-5);
  CHECK(document.at("detectable").at(0).at("factor") == 1.6);
  CHECK(document.at("detectable").at(0).at("runs_for_1_1") == 3000);
  CHECK(document.at("detectable").at(1).at("factor").is_null());
  const std::string text = report::gate_text(worse());
  CHECK(text.starts_with("Worse than the baseline:\nm1 mine k_over_m_1_s: spread was 0.1, is 0.2 (p 1e-05)\n\n"));
  // Two quantities detect no factor below 1.5, and 90 runs would do for both.
  CHECK(text.find("a weak gate: for 2 of 2 quantities") != std::string::npos);
  CHECK(text.find("about 90 runs") != std::string::npos);
  validate::Gate same = worse();
  same.comparison->worse.clear();
  CHECK(report::gate_text(same).starts_with("Nothing is worse than the baseline.\n"));
  CHECK(json::parse(report::gate_json(same)).at("passed") == true);
}
