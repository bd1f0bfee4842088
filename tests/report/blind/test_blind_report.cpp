/// The title of each kind of blind run is the question that its page answers, and what was run stands above it.
#include "report/blind/blind_report.h"

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "report/blind/everyday_targets.h"
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
      "The main cause is named first in 75 % (3 of 4; 95 %: 19 to 99 %). Of 1 target 0 are met, 0 are missed, 1 is "
      "open: "
      "more cases would decide.";
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

TEST_CASE("a target of everyday cases is open unless its interval decides") {
  using report::TargetVerdict;
  const auto of_share = [](std::size_t of, std::size_t yes, double low, double high) {
    return report::verdict_of({"", {of, yes}, {}, low, high});
  };
  CHECK(of_share(1, 1, 0.70, 1.0) == TargetVerdict::open);  // 2 to 100 %
  CHECK(of_share(60, 60, 0.85, 1.0) == TargetVerdict::met);
  CHECK(of_share(60, 30, 0.85, 1.0) == TargetVerdict::missed);
  CHECK(of_share(1, 0, 0.0, 0.03) == TargetVerdict::open);
  CHECK(of_share(200, 0, 0.0, 0.03) == TargetVerdict::met);  // up to 1.8 %
  CHECK(of_share(20, 5, 0.0, 0.03) == TargetVerdict::missed);

  validate::EverydayScore score;
  validate::EverydayMethod& method = score.methods.emplace_back();
  const auto rms = [&](std::size_t of, double each) {
    method.share_error = {of, each * each * static_cast<double>(of), 0.0};
    return report::verdict_of(report::everyday_targets(score)[5]);  // at most 0.1
  };
  CHECK(rms(6, 0.097) == TargetVerdict::open);
  CHECK(rms(200, 0.07) == TargetVerdict::met);  // to 0.078
  CHECK(rms(200, 0.13) == TargetVerdict::missed);
  CHECK(rms(1, 0.01) == TargetVerdict::open);  // one error may be small by chance

  const auto calibration = [&](const validate::EverydayCalibration& of) {
    score.calibration["one"] = of;
    return report::verdict_of(report::everyday_targets(score)[6]);  // at most 0.05
  };
  CHECK(calibration({1, 0.993, 1.0, 0.007, 0.014}) == TargetVerdict::open);  // one right answer
  CHECK(calibration({5, 0.93, 1.0, 0.071, 0.09}) == TargetVerdict::open);    // chance explains it
  CHECK(calibration({1000, 0.90, 0.90, 0.02, 0.01}) == TargetVerdict::met);
  CHECK(calibration({100, 0.95, 0.60, 0.35, 0.03}) == TargetVerdict::missed);
}

TEST_CASE("an open target is null in blind.json, and an estimator that failed comes before every table") {
  report::BlindRun run;
  run.outcomes.resize(1);
  run.outcomes[0].everyday.emplace().shares = {0.9};
  run.outcomes[0].causes.resize(1);
  run.everyday.emplace().methods.emplace_back().main_first["one"]["strong"] = {4, 3};
  const nlohmann::json first = nlohmann::json::parse(report::blind_json(run)).at("targets")[0];
  CHECK(first.at("met").is_null());
  CHECK(first.at("why").at("met") == "the 95 % interval contains the limit");

  validate::EverydayAnswers& answers = run.everyday->answers["one"]["k_over_m_1_s"];
  answers.answered = {1, 1};
  answers.error = {1, 1.0, 1.0};
  fit::OutsideTally& tally = run.outside.emplace();
  tally.name = "mine";
  tally.runs = 2;
  tally.failures[0] = {1, "exit status 1"};
  const std::string page = report::blind_page(run).html, failed = "“mine” failed in 1 of 2 runs";
  CHECK(page.find(failed) < page.find("<table"));
  CHECK(page.find("1.0\u00a01/s</td>") != std::string::npos);
}
