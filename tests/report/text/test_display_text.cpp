#include "report/text/display_text.h"

#include <nlohmann/json.hpp>

#include <set>
#include <string>
#include <vector>

#include "base/text/wrapped_text.h"
#include "diagnose/effects/effect_library.h"
#include "report/diagnosis/diagnosis_json.h"
#include "report/diagnosis/diagnosis_report.h"
#include "report/diagnosis/plan_report.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"

using namespace glidelab;
using report::text_table;

namespace {

diagnose::Diagnosis with_gap() {
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::unknown;
  diagnose::GapSizes gap;
  gap.before = 5.0;
  gap.after = 1.2;
  gap.shrink = 0.95;
  gap.acceleration_before = 0.02;
  gap.acceleration_after = 0.01;
  gap.parameters.push_back({"alpha_deg", diagnose::Against::plumb, "all", 3.0, {}});
  gap.interval95.before = diagnose::GapInterval{4.0, 6.25};
  gap.interval95.after = diagnose::GapInterval{1.0, 1.44};
  gap.interval95.shrink = diagnose::GapInterval{0.9, 1.0};
  gap.interval95.acceleration_before = diagnose::GapInterval{0.01, 0.04};
  diagnosis.gap = gap;
  return diagnosis;
}

nlohmann::json gap_of(const diagnose::Diagnosis& diagnosis) {
  return nlohmann::json::parse(report::diagnosis_json(diagnosis)).at("gap");
}

}  // namespace

TEST_CASE("a gap is written with its intervals over clips, and null with a reason where there is none") {
  const auto gap = gap_of(with_gap());
  CHECK(gap.at("interval95").at("before") == nlohmann::json({4.0, 6.25}));
  CHECK(gap.at("interval95").at("after") == nlohmann::json({1.0, 1.44}));
  CHECK(gap.at("interval95").at("shrink") == nlohmann::json({0.9, 1.0}));
  const auto& acceleration = gap.at("acceleration_m_s2").at("interval95");
  CHECK(acceleration.at("before") == nlohmann::json({0.01, 0.04}));
  CHECK(acceleration.at("after").is_null());
  CHECK_FALSE(acceleration.at("why").at("after").get<std::string>().empty());
  const auto& angle = gap.at("parameters").at(0);
  CHECK(angle.at("z_before") == 3.0);
  CHECK(angle.at("z_after").is_null());
  CHECK_FALSE(angle.at("why").at("z_after").get<std::string>().empty());
}

TEST_CASE("a gap that all but disappears shrinks by over 99.9 %, not by 100 %") {
  diagnose::GapSizes gap = *with_gap().gap;
  CHECK(report::shrink_text(gap) == "shrinks by 95.0 % (90.0 to 100.0 %)");
  gap.shrink = 0.99996;
  CHECK(report::shrink_text(gap) == "shrinks by 100.0 % (90.0 to 100.0 %)");
  gap.interval95.shrink = diagnose::GapInterval{0.9993, 1.0};
  CHECK(report::shrink_text(gap) == "shrinks by over 99.9 %");
  gap.interval95.shrink = {};
  CHECK(report::shrink_text(gap) == "shrinks by over 99.9 %");
}

TEST_CASE("where there are too few clips for an interval, the file and the text say so") {
  diagnose::Diagnosis diagnosis = with_gap();
  diagnosis.gap->interval95 = {
      .before = {}, .after = {}, .shrink = {}, .acceleration_before = {}, .acceleration_after = {}, .too_few = 2};
  const auto gap = gap_of(diagnosis);
  for (const char* key : {"before", "after", "shrink"}) {
    CHECK(gap.at("interval95").at(key).is_null());
    CHECK(gap.at("interval95").at("why").at(key) ==
          "2 clips cannot show how much clips differ: an interval needs three or more");
  }
  CHECK(report::diagnosis_text(diagnosis).find("2 clips cannot show how much clips differ") != std::string::npos);
  CHECK(report::shrink_text(*diagnosis.gap) == "shrinks by 95.0 %");
}

TEST_CASE("intervals read as from what to what") {
  CHECK(report::interval_text(diagnose::GapInterval{4.0, 6.25}) == "4.00 to 6.25");
  CHECK(report::interval_text({}) == "–");
  CHECK(report::shrink_text(*with_gap().gap) == "shrinks by 95.0 % (90.0 to 100.0 %)");
  diagnose::GapSizes larger = *with_gap().gap;
  larger.shrink = -1.678;
  larger.interval95.shrink = {-2.0, 0.1};
  CHECK(report::shrink_text(larger) == "grows by 167.8 % (-10.0 to 200.0 %)");
  const std::string text = report::diagnosis_text(with_gap());
  CHECK(text.find("4.00 to 6.25 before, 1.00 to 1.44 after") != std::string::npos);
  CHECK(text.find("0.02 m/s² (0.0100 to 0.0400) before, 0.01 m/s² after") != std::string::npos);
}

TEST_CASE("every effect that a diagnosis can name has a short name of its own") {
  std::vector<std::string> ids = {"none", "unknown", "smoothing_bias"};
  for (const diagnose::EffectInfo& effect : diagnose::effect_list()) ids.emplace_back(effect.id);
  std::set<std::string> names;
  for (const std::string& id : ids) {
    const std::string name = report::effect_name(id);
    INFO(id);
    CHECK(name != id);
    CHECK(name.find('_') == std::string::npos);
    CHECK(name.size() <= 30);
    names.insert(name);
  }
  CHECK(names.size() == ids.size());
}

TEST_CASE("every effect with a size says what the letters of its size mean, on the pages of diagnosis and plan") {
  for (const diagnose::EffectInfo& effect : diagnose::effect_list()) {
    INFO(effect.id);
    CHECK(report::effect_meaning(effect.id).empty() == (effect.id == std::string_view("compression")));
  }
  CHECK(report::effect_meaning("smoothing_bias") == "intercepts are off by this for each 1/s² of (K/m)²");
  CHECK(report::effect_meaning("none").empty());
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::effect;
  diagnose::DiagnosedEffect effect{};
  effect.id = "eddy_rolloff";
  effect.parameters = {{"v_c_m_s", 2.0, 0.1}};
  of.effects = {effect};
  const std::string words = "K v becomes K v / (1 + (v / v<sub>c</sub>)²)";
  CHECK(report::diagnosis_report("d", of, {}).html.find(words) != std::string::npos);
  diagnose::Plan plan;
  plan.effects = {{"eddy_rolloff", "a magnetic drag", "v_c_m_s", 20.0, true, {}}};
  CHECK(report::plan_page("p", plan).html.find("a magnetic drag: " + words) != std::string::npos);
}

TEST_CASE("effects that act together are named together, and a cause without a name keeps its words") {
  CHECK(report::effect_name("tether") == "tightening cable");
  CHECK(report::effect_name("unknown: friction of each mass") == "unknown: friction of each mass");
  CHECK(report::effect_name("") == "");
  CHECK(report::effect_html("tether") == "tightening cable <small><code>tether</code></small>");
  CHECK(report::effect_html("<b>") == "&lt;b&gt;");
}

TEST_CASE("the page of a diagnosis tells an effect by its name, and its id beside it") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::effect;
  diagnose::DiagnosedEffect effect{};
  effect.id = "load_independent_friction";
  effect.stage = diagnose::Stage::dynamics;
  effect.probability = effect.joint_probability = 0.9;
  of.effects = {effect};
  diagnose::RankedExplanation ranked{};
  ranked.explanation.effects = {"load_independent_friction", "tether"};
  ranked.probability = 0.05;
  ranked.log_evidence_gain = 123456789.123456;
  of.ranking = {ranked, ranked};
  of.ranking[1].explanation.effects = {"tether"};
  of.ranking[1].log_evidence_gain -= 5.84;
  const std::string page = report::diagnosis_report("named", of, {}).html;
  const auto has = [&](const char* part) { return page.find(part) != std::string::npos; };
  CHECK(has("<b>0.900</b><span>load-independent friction, alone or with another</span>"));
  CHECK(has("load-independent friction <small><code>load_independent_friction</code></small>"));
  CHECK(has("load-independent friction + tightening cable"));
  // Both print alike; by how much the second is behind, and nothing at all, is told beside.
  CHECK(has("+1.235·10⁸</td><td class=\"n\">+0.0<"));
  CHECK(has("+1.235·10⁸</td><td class=\"n\">−5.8<"));
  CHECK(has("<td class=\"n\">0</td><td class=\"n\">−1.235·10⁸<"));
}

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

TEST_CASE("a table that fits a terminal has one line a row") {
  CHECK(text_table({{"name", "v (m/s)"}, {"up", "-1.2"}, {"down", "0.24"}}, 1) ==
        "name  v (m/s)\nup       -1.2\ndown     0.24\n");
}

TEST_CASE("a table that is a little too wide has its units on a second line of the head") {
  // 40 + 2 + 23 + 2 + 17 = 84 characters; with units below, 40 + 2 + 17 + 2 + 11 = 72.
  const std::string wide(40, 'a');
  CHECK(text_table({{"name", "terminal velocity (m/s)", "inclination (deg)"}, {wide, "0.24123", "4.3"}}, 1) ==
        std::string(42, ' ') + "terminal velocity  inclination\n" + "name" + std::string(50, ' ') +
            "(m/s)        (deg)\n" + wide + "            0.24123          4.3\n");
}

TEST_CASE("a table that is far too wide is printed in parts that fit, each with the names of its rows") {
  std::vector<std::vector<std::string>> rows = {{"configuration"}, {"0.335 kg, 4°"}, {"0.435 kg, 4°"}};
  for (int c = 0; c < 7; ++c) {
    rows[0].push_back(std::string("column") + static_cast<char>('A' + c));
    rows[1].push_back("0.123456 ± 0.000012");
    rows[2].push_back(std::string("value") + static_cast<char>('A' + c));
  }
  // 13 + 3 (2 + 19) = 76 characters: three columns a part, so three parts of three lines.
  const std::string text = text_table(rows, 1);
  INFO(text);
  std::size_t parts = 0;
  for (std::size_t at = text.find("0.435 kg, 4°"); at != std::string::npos; at = text.find("0.435 kg, 4°", at + 1))
    ++parts;
  CHECK(parts == 3);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    CHECK(base::characters_in(text.substr(at, end - at)) <= base::kTerminalWidth);
    at = end + 1;
  }
  for (char c = 'A'; c < 'H'; ++c) CHECK(text.find(std::string("value") + c) != std::string::npos);
}

TEST_CASE("a last column of words is wrapped below itself") {
  const std::string thirty(30, 'x');  // 1 + 2 + 30 + 1 + 30 = 64 fit, and the third does not
  CHECK(text_table({{"n", "words"}, {"1", thirty + " " + thirty + " " + thirty}, {"2", "short"}}, 2) ==
        "n  words\n1  " + thirty + " " + thirty + "\n   " + thirty + "\n2  short\n");
}

TEST_CASE("a first column of long words is wrapped, with the numbers on the first line of each row") {
  const std::string thirty(30, 'x');
  CHECK(text_table({{"of blind cases", "found"}, {thirty + " " + thirty + " " + thirty, "97 %"}, {"all", "3 %"}}, 1) ==
        "of blind cases" + std::string(49, ' ') + "found\n" + thirty + " " + thirty + "   97 %\n" + thirty + "\nall" +
            std::string(60, ' ') + "  3 %\n");
}
