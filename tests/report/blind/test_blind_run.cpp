#include "report/blind/blind_run.h"

#include <string>
#include <utility>
#include <vector>

#include "report/blind/blind_report.h"
#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("every method of deciding and every verdict without an effect has words") {
  using validate::DecisionMethod;
  const std::vector<std::pair<DecisionMethod, std::string>> methods = {
      {DecisionMethod::diagnosis, "glidelab diagnose"},
      {DecisionMethod::best_residual, "refit that lowers the residuals most"},
      {DecisionMethod::stepwise_bic, "stepwise BIC"},
      {DecisionMethod::picking, "picking at random"},
      {DecisionMethod::forward_selection, "forward selection by held-out residuals"}};
  CHECK(methods.size() == static_cast<std::size_t>(DecisionMethod::forward_selection) + 1);
  for (const auto& [method, words] : methods) CHECK(report::method_name(method) == words);
  std::vector<std::string> verdicts;
  for (const validate::VerdictWithout one : validate::kVerdictsWithout) verdicts.push_back(report::without_words(one));
  CHECK(verdicts == std::vector<std::string>{"another name", "another name, probability over 0.8", "equivalent",
                                             "failed", "none", "unknown"});
}

TEST_CASE("a confusion matrix names the truth and what was said, and counts how many of two effects were named") {
  report::BlindRun run;
  run.outcomes.resize(1);
  run.score.methods.resize(1);
  run.score.confusion = {{{}, {{"unknown", 1}}, {{0, 1}, {2, 3}}}, {"none", {{"none", 4}, {"tether", 1}}}};
  const auto rows = report::confusion_words(run.score);
  CHECK(rows.at("two effects") ==
        std::map<std::string, std::size_t>{{"0 of the two named", 1}, {"2 of the two named", 3}, {"unknown", 1}});
  CHECK(rows.at("none") == std::map<std::string, std::size_t>{{"none", 4}, {"tether", 1}});
  const std::string text = report::blind_text(run);
  CHECK(text.find("2 of the two named 3, 0 of the two named 1, unknown 1") != std::string::npos);
}
