/// The title of each kind of blind run is the question that its page answers, and what was run stands above it.
#include "report/blind/blind_report.h"

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
