#include "report/text/display_text.h"

#include <set>

#include "diagnose/effects/effect_library.h"
#include "report/diagnosis/diagnosis_report.h"
#include "report/diagnosis/plan_report.h"
#include "tests/catch.h"

using namespace glidelab;

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
