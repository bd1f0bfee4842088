#include "report/diagnosis/given_causes_report.h"

#include <string>

#include "report/analysis/analysis_report.h"
#include "report/analysis/result_files.h"
#include "tests/catch.h"
#include "tests/report/made_diagnoses.h"
#include "tests/report/made_results.h"
#include "tests/report/text_of_pages.h"

using namespace glidelab;
using tests::has;

namespace {

/// Quadratic drag in the model for the first of two masses; the other one's clips took no part.
diagnose::GivenCauses made_given() {
  diagnose::GivenCauses given;
  given.causes = {{"quadratic_drag", {{"c_kg_m", 0.0031, 0.0002}}}};
  given.recovered = {tests::made_recovered("flat", 0.335, {"quadratic_drag"})};
  given.recovered[0].v_lim_m_s = core::Quantity{{}, core::WhyUnknown{core::unknown::NoBalance{}}};
  given.gap_before = 5.3;
  given.gap_after = 1.02;
  given.standard_error = 0.04;
  given.notes = {diagnose::OnlyFalls{}};
  return given;
}

core::AnalysisResults in_doubt() {
  core::AnalysisResults results = tests::made_results();
  results.configurations[0].mu = tests::known(-0.01, 0.001);  // no friction can cause that
  return results;
}

}  // namespace

TEST_CASE("the screen has both columns, the size of the effect, and what it does to the gap") {
  const std::string text = report::given_causes_text(tests::made_results(), made_given());
  INFO(text);
  CHECK(has(text, "With this effect in the model: quadratic drag"));
  CHECK(has(text, "c = 0.00310 ± 0.00020 kg/m"));
  CHECK(has(text, "falls from 5.30 to 1.02 times the noise"));
  CHECK(has(text, "2.7680 ± 0.0060"));  // by the law alone
  CHECK(has(text, "2.7463 ± 0.0060"));  // 0.92/0.335, with the effect
  CHECK(has(text, "2.7345 to 2.7580"));
  CHECK(has(text,
            "0.335 kg, 4°: no terminal velocity with the effect: the forces do not balance at any downhill speed below "
            "1000 m/s"));
  CHECK(has(text, "0.435 kg, 4°: no K/m with the effect: its clips hold too little free motion"));
  CHECK_FALSE(has(text, "the law alone *"));
  CHECK_FALSE(has(text, "reach a minimum"));
}

TEST_CASE("where the law alone does not fit, the ± of its column is marked as holding only if it did") {
  const std::string text = report::given_causes_text(in_doubt(), made_given());
  CHECK(has(text, "the law alone *"));
  CHECK(has(text, "* The law alone does not fit these clips: its ± would hold only if it did."));
}

TEST_CASE("an effect that closes no gap, a rest, and a fit without a minimum are said") {
  diagnose::GivenCauses given = made_given();
  given.gap_after = 5.25;
  given.converged = false;
  const std::string text = report::given_causes_text(tests::made_results(), given);
  CHECK(has(text, "does not fall (5.30 before, 5.25 after"));
  CHECK(has(text, "What is left counts as noise"));
  CHECK(has(text, "did not reach a minimum"));
}

TEST_CASE("results.json gains one object, and nothing else of it changes") {
  const core::AnalysisResults results = tests::made_results();
  const report::Json plain = report::Json::parse(report::results_json(results));
  report::Json with = report::Json::parse(report::results_json(results, report::given_causes_json(made_given())));
  REQUIRE(with.contains("with"));
  const report::Json given = with.at("with");
  CHECK(given.at("effects").at(0).at("id") == "quadratic_drag");
  CHECK(given.at("effects").at(0).at("parameters").at("c_kg_m").at("value") == 0.0031);
  CHECK(given.at("gap").at("after") == 1.02);
  CHECK(given.at("recovered").at(0).at("with").at(0) == "quadratic_drag");
  CHECK(given.at("recovered").at(0).at("k_over_m_1_s").contains("interval95"));
  CHECK(given.at("recovered").at(0).at("v_lim_m_s").is_null());
  CHECK(given.at("recovered").at(0).at("why").contains("v_lim_m_s"));
  CHECK(given.at("converged") == true);
  CHECK(given.at("notes").size() == 1);
  with.erase("with");
  CHECK(with == plain);
}

TEST_CASE("the page of an analysis has the section after the recovered values") {
  const core::AnalysisResults results = tests::made_results();
  const report::Page page = report::analysis_report("made", results, {}, base::no_progress,
                                                    report::given_causes_section(results, made_given()));
  const std::size_t recovered = page.html.find("id=\"recovered\""), with = page.html.find("id=\"with\""),
                    phase = page.html.find("id=\"phase\"");
  REQUIRE(with != std::string::npos);
  CHECK(recovered < with);
  CHECK(with < phase);
}

TEST_CASE("a group's name on the section is text") {
  core::AnalysisResults results = tests::made_results();
  diagnose::GivenCauses given = made_given();
  results.configurations[1].mass_kg = 0.335;  // so that the groups tell the two apart
  results.configurations[1].group = tests::kEvil;
  given.recovered[0].group = tests::kEvil;
  tests::check_is_text(
      report::analysis_report("made", results, {}, base::no_progress, report::given_causes_section(results, given)));
}
