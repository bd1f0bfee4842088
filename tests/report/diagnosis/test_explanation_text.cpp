#include "report/diagnosis/words/diagnosis_words.h"

#include "tests/catch.h"

using namespace glidelab;
using diagnose::Explanation;

TEST_CASE("an explanation has the id that files have had: effects joined by plus signs, what has no name last") {
  CHECK(report::explanation_id({}) == "none");
  CHECK(report::explanation_id({{}, true}) == "unknown");
  CHECK(report::explanation_id({{"tether"}}) == "tether");
  CHECK(report::explanation_id({{"scale_error", "tether"}}) == "scale_error + tether");
  CHECK(report::explanation_id({{"scale_error"}, true}) == "scale_error + unknown");
}

TEST_CASE("an explanation of several effects has the short name of each, with its id beside them") {
  const Explanation both{{"quadratic_drag", "tether"}, true};
  CHECK(report::explanation_name(both) == "quadratic drag + tightening cable + an unnamed cause");
  CHECK(report::explanation_html({{"tether"}}) == "tightening cable <small><code>tether</code></small>");
  CHECK(report::explanation_html({{"<b>"}}) == "&lt;b&gt;");
}

TEST_CASE("a probability for a person is never 0 % or 100 %") {
  CHECK(report::percent(0.874) == "87 %");
  CHECK(report::percent(0.9951) == "more than 99 %");
  CHECK(report::percent(0.0049) == "less than 1 %");
}
