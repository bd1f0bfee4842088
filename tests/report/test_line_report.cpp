/// The table of explanations of a diagnosed table of lines.
#include "report/line_report.h"

#include "catch.h"

using namespace glidelab;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("an explanation of lines has its sizes in units, and its words once") {
  diagnose::Diagnosis of;
  of.verdict = "unknown";
  diagnose::LineComparison lines;
  lines.lines = 4;
  lines.candidates = {{"load_independent_friction + unknown",
                       "a drag of each direction",
                       0.9,
                       6.2,
                       13.5,
                       3,
                       {{"force_n", 0.0238, 0.0011}},
                       3.0,
                       0.8,
                       ""}};
  of.lines = lines;
  CHECK(report::line_rows(lines).at(1).at(1) == "force = 23.8 ± 1.1 mN");
  const std::string page = report::line_report("lines", of).html;
  CHECK(has(page, "friction whatever the load + something without a name"));
  CHECK(has(page, "<code>load_independent_friction + unknown</code></small>: a drag of each direction<"));
  CHECK_FALSE(has(page, "unknown: a drag of each direction</code>"));
}
