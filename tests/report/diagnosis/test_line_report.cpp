/// The table of explanations of a diagnosed table of lines.
#include "report/diagnosis/line_report.h"

#include <stdexcept>

#include "report/diagnosis/diagnosis_plots.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("an explanation of lines has its sizes in units, and its words once") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::unknown;
  diagnose::LineComparison lines;
  lines.lines = 4;
  lines.candidates = {
      {{{"load_independent_friction"}, true},
       diagnose::UnnamedInLines{diagnose::UnnamedInLines::What::drag, diagnose::UnnamedInLines::Over::direction},
       0.9,
       6.2,
       13.5,
       3,
       {{"force_n", 0.0238, 0.0011}},
       3.0,
       0.8,
       {}}};
  of.lines = lines;
  CHECK(report::line_rows(lines).at(1).at(1) == "force = 23.8 ± 1.1 mN");
  const std::string page = report::line_report("lines", of).html;
  CHECK(has(page, "load-independent friction + an unnamed cause"));
  CHECK(has(page, "<code>load_independent_friction + unknown</code></small>: a separate drag for each direction<"));
  CHECK_FALSE(has(page, "unknown: a separate drag for each direction</code>"));
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
