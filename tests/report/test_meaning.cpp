#include "report/meaning.h"

#include <limits>

#include "catch.h"
#include "made_results.h"
#include "report/analysis_report.h"
#include "report/blind_targets.h"
#include "report/text_table.h"

using namespace glidelab;

namespace {

bool any_has(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts) {
    if (text.find(part) != std::string::npos) return true;
  }
  return false;
}

/// One clip whose lines the noise explains: their random part is as good as known.
core::AnalysisResults one_clip() {
  core::AnalysisResults results;
  results.clips = {tests::made_clip("up", 2.7, 0.8, 0.65)};
  for (core::LineFit& line : results.clips[0].segments) line.parts.degrees = std::numeric_limits<double>::infinity();
  core::ConfigurationResult configuration;
  configuration.mass_kg = 0.335;
  configuration.incline_deg = 4.3;
  configuration.group = "slope";
  configuration.k_over_m_1_s = tests::known(2.7, 0.006);
  configuration.mu = tests::known(0.0071, 0.0002);
  configuration.lines = results.clips[0].segments;
  results.configurations = {configuration};
  return results;
}

}  // namespace

TEST_CASE("where the law serves, nothing is doubted and no next step is named") {
  CHECK(report::doubts_about(one_clip()).empty());
  CHECK(report::analysis_text(one_clip()).find("glidelab diagnose") == std::string::npos);
}

TEST_CASE("a drag or a friction below zero by more than chance is doubted, by less is not") {
  core::AnalysisResults results = one_clip();
  results.configurations[0].k_over_m_1_s = tests::known(-0.367, 0.055);
  CHECK(any_has(report::doubts_about(results), "K/m = -0.367 ± 0.055 is below zero"));
  CHECK(report::meaning_of(results).find("slows it at -") == std::string::npos);
  results.configurations[0].k_over_m_1_s = tests::known(-0.367, 0.355);
  CHECK(report::doubts_about(results).empty());
  results.configurations[0].mu = tests::known(-0.010, 0.002);
  CHECK(any_has(report::doubts_about(results), "µ = -0.0100 ± 0.0020 is below zero"));
}

TEST_CASE("points far off their line are told with the clip and the next step, on the page and in the terminal") {
  core::AnalysisResults results = one_clip();
  results.clips[0].segments[1].parts.degrees = 7.0;
  results.clips[0].segments[1].parts.scatter = 38.4;
  CHECK(any_has(report::doubts_about(results), "up, v > 0: the points lie 38 times as far off their line"));
  CHECK(any_has(report::doubts_about(results), "Next: glidelab check"));
  CHECK(report::analysis_text(results).find("38 times") != std::string::npos);
  CHECK(report::meaning_of(results).find("v &gt; 0: the points lie 38 times") != std::string::npos);
  results.clips[0].segments[1].parts.scatter = 1.4;
  CHECK(report::doubts_about(results).empty());
}

TEST_CASE("where the law is in doubt the doubt comes first and the numbers are called no more than what a fit gives") {
  core::AnalysisResults results = one_clip();
  results.configurations[0].mu = tests::known(-0.010, 0.002);
  const std::string doubted = report::meaning_of(results);
  const std::size_t doubt = doubted.find("does not fit"), number = doubted.find("K/m = 2.7");
  REQUIRE(doubt != std::string::npos);
  REQUIRE(number != std::string::npos);
  CHECK(doubt < number);
  CHECK(doubted.find("need not be a property") < number);
  CHECK(doubted.find("slows it at") == std::string::npos);
  CHECK(doubted.find("Coulomb friction is") == std::string::npos);
  const std::string page = report::analysis_report("doubted", results, {}).html;
  CHECK(page.find("does not fit") < page.find("id=\"recovered\""));
  CHECK(report::meaning_of(one_clip()).find("Coulomb friction is µ = 0.0071") != std::string::npos);
  results.configurations[0].mu = tests::known(-0.002, 0.002);
  CHECK(report::meaning_of(results).find("no Coulomb friction can be told from zero") != std::string::npos);
}

TEST_CASE("what blind cases mean is told of what was there, with intervals, and what is missed is named") {
  validate::BlindScore score;
  score.methods.resize(1);
  score.methods[0].single["strong"] = {4, 4};
  score.false_alarm = {10, 1};
  score.calibration_error = 0.02;
  const auto has = [&](const char* part) { return report::blind_meaning(score).find(part) != std::string::npos; };
  // Clopper and Pearson, all of n: the lower end is 0.025^(1/n), 0.398 of 4.
  CHECK(has("in 100 % (4 of 4; 95 %: 40 to 100 %)"));
  CHECK(has("can be taken at its word"));
  CHECK(has("Missed: nothing: another verdict than none"));  // 10 % of at most 5
  CHECK_FALSE(has("moderate"));
  score.false_alarm = {20, 1};
  CHECK(has("All 3 targets"));  // one strong effect, nothing wrong, the calibration
  score.calibration_error = 0.2;
  score.reliability = {{0.8, 1.0, 0.9, {10, 7}}};
  CHECK(has("too sure of itself"));
  score.reliability[0].stated = 0.5;
  CHECK(has("too modest"));
  CHECK(has("Missed: the expected calibration error"));  // no other: 5 % of false alarms are allowed
}
