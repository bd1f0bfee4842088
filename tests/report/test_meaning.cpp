#include "report/meaning.h"

#include <limits>

#include "catch.h"
#include "made_results.h"
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
