/// The table of explanations of a diagnosed table of lines.
#include "report/diagnosis/line_report.h"

#include <stdexcept>

#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/words/line_words.h"
#include "report/diagnosis/words/verdict_words.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("an explanation of lines has its sizes in units, and its words once") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::none;
  diagnose::LineComparison lines;
  lines.lines = 4;
  lines.candidates = {{{{"load_independent_friction", "configuration_drag"}},
                       {{"configuration_drag", diagnose::LinesOver::mass}},
                       0.9,
                       6.2,
                       13.5,
                       3,
                       {{"force_n", 0.0238, 0.0011}, {"sd_n_s_m", 0.012, 0.001}},
                       3.0,
                       0.8,
                       {}}};
  of.lines = lines;
  CHECK(report::line_rows(lines).at(1).at(1) == "force = 23.8 ± 1.1 mN, sd = 0.0120 ± 0.0010 N s/m");
  const std::string page = report::line_report("lines", of).html;
  CHECK(has(page, "load-independent friction + drag by configuration"));
  CHECK(has(page, "<code>load_independent_friction + configuration_drag</code></small>: a separate K for each mass<"));
}

TEST_CASE("of a pair of effects in many forms those have a row that are likely, of a single effect the likeliest") {
  diagnose::LineComparison lines;
  const auto add = [&](std::vector<std::string> effects, diagnose::LinesOver over, double probability) {
    lines.candidates.push_back(
        {{std::move(effects)}, {{"configuration_friction", over}}, probability, 1.0, 1.0, 1, {}, {}, {}, {}});
  };
  using enum diagnose::LinesOver;
  add({"configuration_friction"}, mass_and_set_up, 0.6);
  add({"smoothing_bias", "configuration_friction"}, set_up, 0.02);
  add({"smoothing_bias", "configuration_friction"}, mass, 0.005);
  add({"configuration_friction"}, set_up, 0.004);
  lines.candidates.push_back({{{"direction_dependent_drag"}}, {}, 0.001, 1.0, 1.0, 1, {}, {}, {}, {}});
  const auto rows = report::line_rows(lines);
  REQUIRE(rows.size() == 4);
  CHECK(rows[1].front() == "configuration_friction: a separate µ for each mass in each set-up");
  CHECK(rows[2].front() == "smoothing_bias + configuration_friction: a separate µ for each set-up");
  CHECK(rows[3].front() == "direction_dependent_drag");
}

TEST_CASE("what differs between configurations of lines is told from the least to the most, and in a table") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::effect;
  diagnose::DiagnosedEffect effect{
      "configuration_friction", diagnose::Stage::dynamics, "a dry friction of each", 0.8, {}, {}};
  effect.parameters = {{"sd", 0.0014, 0.0002},
                       {"mu.335 g, 0°", 0.0075, 0.0001},
                       {"mu.335 g, 4°", 0.0071, 0.0001},
                       {"mu.535 g, 4°", 0.0040, 0.0001}};
  of.effects = {effect};
  of.ranking = {{{{"configuration_friction"}}, 0.8, 1.0, 1.0, 1, {}}};
  of.lines.emplace();
  of.lines->lines = 12;
  of.lines->candidates = {{{}, {}, 0.1, 0.0, 0.0, 0, {}, {}, {}, {}},
                          {{{"configuration_friction"}}, {}, 0.8, 1.0, 1.0, 2, {{"sd", 0.0014, 0.0002}}, {}, {}, {}}};
  of.levels = diagnose::GapLevels{7.4, 1.4, {}, true};
  const std::string words = report::line_words(of);
  CHECK(has(words, "µ from 0.00400 ± 0.00010 (535 g, 4°) to 0.00750 ± 0.00010 (335 g, 0°)."));
  CHECK(words.starts_with("The law holds within each configuration (gap 1.4); across them it does not (7.4)."));
  CHECK(has(report::line_report("lines", of).html, "<h2>What differs</h2>"));
}

TEST_CASE("the chart of what was held out speaks of lines where lines were held out, of clips else") {
  diagnose::Diagnosis of;
  of.gap.emplace();
  of.gap->held_out = {"one"};
  of.gap->before_by_clip = {3.0};
  of.gap->after_by_clip = {1.0};
  const report::Plot clips = report::verdict_plots(of).at(1);
  CHECK(has(clips.drawing.script, "residuals of the held-out clip / noise"));
  CHECK(has(clips.caption, "left out of the fit"));
  of.lines.emplace();
  const report::Plot lines = report::verdict_plots(of).at(1);
  CHECK(has(lines.drawing.script, "deviation from the prediction of the others / own scatter"));
  CHECK(has(lines.caption, "the lines' own scatter"));
}

TEST_CASE("residuals lie over place, speed or time, and over nothing else") {
  const diagnose::ResidualCurve curve{"one", {1.0}, {2.0}, {3.0}, {}, {}};
  CHECK(report::along(curve, diagnose::GapVariable::time).front() == 1.0);
  CHECK(report::along(curve, diagnose::GapVariable::position).front() == 2.0);
  CHECK(report::along(curve, diagnose::GapVariable::speed).front() == 3.0);
  CHECK_THROWS_AS(report::along(curve, diagnose::GapVariable::mass), std::logic_error);
}
