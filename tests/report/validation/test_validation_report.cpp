#include "report/validation/validation_report.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <sstream>
#include <string>

#include "base/text/wrapped_text.h"
#include "tests/catch.h"

using namespace glidelab;
using nlohmann::json;

namespace {

validate::QuantityComparison quantity(const char* configuration, const char* estimator, const char* key,
                                      std::optional<double> truth, std::optional<double> value, double sd) {
  const std::optional<double> error = truth && value ? std::optional(*value - *truth) : std::nullopt;
  return {configuration, 0.335, 4.0, estimator, key, truth, value, value ? std::optional(sd) : std::nullopt, error, {}};
}

/// One configuration on a slope by both estimators; of the four values one is three standard deviations off.
validate::Comparison made_comparison() {
  validate::Comparison comparison;
  comparison.quantities = {quantity("m1", "phase-diagram", "k_over_m_1_s", 2.768, 2.780, 0.004),
                           quantity("m1", "phase-diagram", "mu", 0.0071, 0.0072, 0.0002),
                           quantity("m1", "trajectory", "k_over_m_1_s", 2.768, 2.7681, 0.0004),
                           quantity("m1", "trajectory", "mu", 0.0071, 0.00712, 0.00002)};
  comparison.lines = {{"m1-up", -1, 0.9999}};
  comparison.frames = 40;
  comparison.detected = 39;
  return comparison;
}

std::string before_full(const std::string& text) {
  return text.substr(0, text.find("\nIn full:\n"));
}

}  // namespace

TEST_CASE("the few numbers that matter come before the table: the better estimator's, beside their truth") {
  const std::string text = report::comparison_text(made_comparison());
  REQUIRE(text.find("\nIn full:\n") != std::string::npos);
  const std::string first = before_full(text);
  INFO(first);
  CHECK(first.find("fit of the whole motion") != std::string::npos);
  CHECK(first.find("K/m (1/s)") != std::string::npos);
  CHECK(first.find("m1 (0.335 kg, 4°)") != std::string::npos);
  CHECK(first.find("m1 (0.335 kg, 4°):\n") != std::string::npos);
  CHECK(first.find("K/m (1/s)    2.76810 ± 0.00040   2.76800\n") != std::string::npos);
  CHECK(first.find("µ          0.007120 ± 0.000020  0.007100\n") != std::string::npos);
  CHECK(first.find("2.780") == std::string::npos);  // the lines' value is below
  CHECK(first.find("α (°)") == std::string::npos);  // of which nothing is known here
  CHECK(first.find(
            "3 of 4 recovered values lie within two standard deviations of the truth; the largest error: K/m of m1 "
            "with the lines of the phase diagram, 3.0 standard deviations.") != std::string::npos);
  CHECK(text.find("marker found in 39 of 40 frames") != std::string::npos);
}

TEST_CASE("of several configurations the middle mass that was recovered comes first, and all follow") {
  validate::Comparison comparison;
  const auto add = [&](const char* name, double mass_kg, std::optional<double> value) {
    comparison.quantities.push_back(quantity(name, "trajectory", "k_over_m_1_s", 2.0, value, 0.001));
    comparison.quantities.back().mass_kg = mass_kg;
  };
  add("light", 0.2, 2.001);
  add("lost", 0.25, std::nullopt);
  add("heavy", 0.8, 2.003);
  add("middle", 0.4, 2.002);
  const std::string text = report::comparison_text(comparison), first = before_full(text);
  INFO(first);
  CHECK(first.find("\n\nmiddle (0.4 kg, 4°), one of 3 configurations:\nquantity") != std::string::npos);
  CHECK(first.find("2.0020 ± 0.0010") != std::string::npos);
  CHECK(first.find("2.0010") == std::string::npos);
  for (const char* value : {"2.0010", "2.0020", "2.0030", "lost (0.25 kg, 4°)"}) {
    CHECK(text.find(value, first.size()) != std::string::npos);
  }
}

TEST_CASE("a comparison begins with an outside estimator's failure, and calls it by its name") {
  validate::Comparison comparison = made_comparison();
  comparison.quantities.push_back(quantity("m1", "mine", "mu", 0.0071, 0.0171, 0.0001));
  CHECK(report::comparison_text(comparison).find("the largest error: µ of m1 with “mine”, 100 standard deviations") !=
        std::string::npos);
  comparison.outside =
      fit::tally_of("mine", "", {{fit::OutsideFailure::exit_status, "exit status 7: skipped: no pynumdiff", 1.0}});
  CHECK(report::comparison_text(comparison)
            .starts_with("“mine” failed in 1 of 1 run: 1 ended with an exit status other than 0, the first: exit "
                         "status 7: skipped: no pynumdiff. 3 of 5 recovered"));
}

TEST_CASE("a quantity that these motions do not have has no row, and one that was not recovered keeps its row") {
  validate::Comparison comparison = made_comparison();
  comparison.quantities.push_back(quantity("m1", "trajectory", "v_lim_m_s", std::nullopt, std::nullopt, 0.0));
  CHECK(report::comparison_text(comparison).find("terminal velocity (m/s)") == std::string::npos);
  comparison.quantities.back().truth = 0.24;
  CHECK(report::comparison_text(comparison).find("terminal velocity (m/s)") != std::string::npos);
}

TEST_CASE("without a fit of the whole motion the lines' numbers come first, and a truth that is none is explained") {
  validate::Comparison comparison = made_comparison();
  comparison.quantities = {quantity("m1", "phase-diagram", "k_over_m_1_s", std::nullopt, 2.780, 0.004),
                           quantity("m1", "trajectory", "k_over_m_1_s", std::nullopt, std::nullopt, 0.0)};
  const std::string first = before_full(report::comparison_text(comparison));
  INFO(first);
  CHECK(first.find("lines of the phase diagram") != std::string::npos);
  CHECK(first.find("2.7800 ± 0.0040      –\n") != std::string::npos);
  CHECK(first.find("A truth of \"–\"") != std::string::npos);
  CHECK(first.find("No recovered value could be compared with a true one.") != std::string::npos);
}

TEST_CASE("a configuration's name cannot steer the terminal, and is text on the page") {
  validate::Comparison comparison = made_comparison();
  for (validate::QuantityComparison& q : comparison.quantities) q.configuration = "\x1b[2J<i>";
  CHECK(report::comparison_text(comparison).find('\x1b') == std::string::npos);
  CHECK(report::meaning_of(comparison).find("<i>") == std::string::npos);
}

TEST_CASE("the tables of a comparison fit a terminal, each under the estimator's name for people") {
  validate::Comparison comparison = made_comparison();
  for (validate::QuantityComparison& q : comparison.quantities) q.configuration = "a glider with quite a long name";
  const std::string text = report::comparison_text(comparison);
  const std::string tables = text.substr(text.find("\n\n"));
  INFO(tables);
  std::istringstream lines(tables);
  for (std::string line; std::getline(lines, line);) CHECK(base::characters_in(line) <= base::kTerminalWidth);
  CHECK(text.find("(0.335 kg, 4°), lines of the phase diagram:\nquantity ") != std::string::npos);
  CHECK(text.find("(0.335 kg, 4°), fit of the whole motion:\nquantity ") != std::string::npos);
}

TEST_CASE("comparison.json has every key of its form, and what is missing is null with a reason") {
  validate::Comparison comparison;
  const core::WhyUnknown level{core::unknown::Told{"level"}};
  comparison.quantities = {
      {"m1", 0.335, 4.0, "phase-diagram", "k_over_m_1_s", 2.76, 2.763, 0.004, 0.003, {}},
      {"m1", 0.335, 4.0, "phase-diagram", "v_lim_m_s", std::nullopt, std::nullopt, std::nullopt, std::nullopt, level},
      {"m1", 0.335, 4.0, "phase-diagram", "mu", std::nullopt, 0.001, 0.002, std::nullopt, {}}};
  comparison.lines = {{"m1-up", -1, 0.9999}};
  comparison.restitution = {1.1e-5, 4e-5, 1.6, {{0, 0.0, 0.1, 1.1e-5}}};
  comparison.frames = 4100;
  comparison.detected = 4099;
  comparison.wall_s = 41.2;
  const json document = json::parse(report::comparison_json(comparison));
  CHECK(document.at("format") == 1);
  const json& quantity = document.at("quantities").at(0);
  CHECK(quantity.at("configuration") == "m1");
  CHECK(quantity.at("mass_kg") == 0.335);
  CHECK(quantity.at("incline_deg") == 4.0);
  CHECK(quantity.at("estimator") == "phase-diagram");
  CHECK(quantity.at("quantity") == "k_over_m_1_s");
  CHECK(quantity.at("truth") == 2.76);
  CHECK(quantity.at("value") == 2.763);
  CHECK(quantity.at("sd") == 0.004);
  CHECK(quantity.at("error") == 0.003);
  CHECK(document.at("quantities").at(1).at("value").is_null());
  CHECK(document.at("quantities").at(1).at("why").at("value") == "level");
  CHECK(document.at("quantities").at(2).at("error").is_null());
  CHECK(document.at("quantities").at(2).at("value") == 0.001);
  CHECK(document.at("lines").at(0) == json({{"clip", "m1-up"}, {"direction", -1}, {"r2", 0.9999}}));
  CHECK(document.at("restitution").at("rms_m") == 1.1e-5);
  CHECK(document.at("restitution").at("max_m") == 4e-5);
  CHECK(document.at("restitution").at("field_m") == 1.6);
  CHECK(document.at("frames") == 4100);
  CHECK(document.at("detected") == 4099);
  CHECK(document.at("wall_s") == 41.2);
}
