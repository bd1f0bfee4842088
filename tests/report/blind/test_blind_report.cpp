/// The title of each kind of blind run is the question that its page answers, and what was run stands above it.
#include "report/blind/blind_report.h"

#include <string>
#include <string_view>

#include "tests/catch.h"

using namespace glidelab;

namespace {

std::string heading_of(const report::BlindRun& run) {
  const std::string html = report::blind_page(run).html;
  const std::size_t from = html.find("<h1>"), to = html.find("</h1>");
  REQUIRE(from != std::string::npos);
  REQUIRE(to != std::string::npos);
  return html.substr(from, to - from);
}

}  // namespace

TEST_CASE("the page of blind cases asks how often the diagnosis is right, and says what was run") {
  report::BlindRun run;
  run.seed = 17;
  run.outcomes.resize(3);
  run.score.methods.resize(1);
  CHECK(heading_of(run) == "<h1><small>blind cases: 3 tracks, seed 17</small> How often is the diagnosis right?");
  run.images = true;
  CHECK(heading_of(run) == "<h1><small>blind cases: 3 films, seed 17</small> How often is the diagnosis right?");
  run.images = false;
  run.everyday.emplace().methods.resize(1);
  for (validate::BlindOutcome& outcome : run.outcomes) outcome.everyday.emplace();
  CHECK(heading_of(run) ==
        "<h1><small>blind cases: 3 everyday tracks, seed 17</small> How often is the diagnosis right about experiments "
        "as students record them?");
}

TEST_CASE(
    "blind cases are answered in one line, on the page above all tables, and causes have their names for people") {
  report::BlindRun run;
  run.outcomes.resize(1);
  run.outcomes[0].everyday.emplace().shares = {0.9};
  run.outcomes[0].causes.resize(1);
  run.outcomes[0].causes[0].id = "quadratic_drag";
  validate::EverydayMethod& method = run.everyday.emplace().methods.emplace_back();
  method.main_first["one"]["strong"] = {4, 3};
  const std::string answer =
      "The main cause is named first in 75 % (3 of 4; 95 %: 19 to 99 %); 0 of 1 targets are met.";
  CHECK(report::blind_text(run).starts_with(answer + "\n\n"));
  std::string everyday = report::blind_page(run).html;
  constexpr std::string_view kNoBreak = "\u00a0";
  for (std::size_t at = 0; (at = everyday.find(kNoBreak, at)) != std::string::npos;) {
    everyday.replace(at, kNoBreak.size(), " ");
  }
  CHECK(everyday.find("<b>" + answer) < everyday.find("<table"));
  CHECK(everyday.find("quadratic drag 90 %") != std::string::npos);
  CHECK(everyday.find("quadratic_drag") == std::string::npos);
  CHECK(everyday.find("<summary>All cases") < everyday.find("quadratic drag 90 %"));

  run.everyday.reset();
  run.score.methods.resize(1);
  run.score.methods[0].single["strong"] = {2, 2};
  run.score.calibration_error = 0.01;
  CHECK(report::blind_text(run).starts_with(
      "One strong effect is named first in 100 % (2 of 2); 2 of 2 targets are met.\n"));
  const std::string page = report::blind_page(run).html;
  CHECK(page.find("quadratic drag") != std::string::npos);
  CHECK(page.find("quadratic_drag") == std::string::npos);
}
