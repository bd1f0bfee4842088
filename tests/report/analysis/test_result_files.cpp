#include "report/analysis/result_files.h"

#include <nlohmann/json.hpp>

#include <limits>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "report/text/display_text.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using nlohmann::json;

TEST_CASE("results.json has every key of its form, with the numbers that were put in") {
  core::AnalysisResults results = tests::made_results();
  results.plumbs = {{"flat", tests::known(4.1, 0.2)}};
  const json document = json::parse(report::results_json(results));
  CHECK(document.at("format") == 1);
  CHECK(document.at("estimator") == "phase-diagram");
  REQUIRE(document.at("clips").size() == 2);
  const json& clip = document.at("clips").at(0);
  CHECK(clip.at("name") == "m1-up");
  CHECK(clip.at("frames") == 300);
  CHECK(clip.at("detected") == 299);
  CHECK(clip.at("bandwidth_s") == 0.043);
  CHECK(clip.at("bandwidth_method") == "given");
  CHECK(clip.at("position_noise_m") == 2.1e-5);
  const json& segment = clip.at("segments").at(0);
  CHECK(segment.at("direction") == -1);
  CHECK(segment.at("points") == 100);
  CHECK(segment.at("k_over_m_1_s").at("value") == 2.768);
  CHECK(segment.at("k_over_m_1_s").at("sd") == 0.006);
  CHECK(segment.at("k_over_m_1_s").at("interval95") == json::array({2.768 - 1.96 * 0.006, 2.768 + 1.96 * 0.006}));
  CHECK(segment.at("a0_m_s2").at("value") == 0.8063);
  CHECK(segment.at("r2") == 0.99993);
  CHECK(clip.at("v_lim_m_s").at("value") == 0.667 / 2.768);
  const json& configuration = document.at("configurations").at(1);
  CHECK(configuration.at("mass_kg") == 0.435);
  CHECK(configuration.at("incline_deg") == 4.0);
  CHECK(configuration.at("clips") == json::array({"m2-up"}));
  for (const char* key : {"k_over_m_1_s", "mu", "alpha_deg", "v_lim_m_s"}) {
    CHECK(configuration.at(key).at("interval95").size() == 2);
  }
  CHECK(document.at("calibration").at("camera_matrix").size() == 9);
  CHECK(document.at("calibration").at("rms_px") == 0.04);
  CHECK(document.at("calibration").at("restitution_rms_m") == 2e-5);
  CHECK(document.at("inclination").at("plumb_deg").at("value") == 4.1);
}

TEST_CASE("results.json says in words what the law cannot explain") {
  core::AnalysisResults results = tests::made_results();
  CHECK(json::parse(report::results_json(results)).at("doubts") == json::array());
  results.configurations[0].k_over_m_1_s = tests::known(-0.367, 0.055);
  const json doubts = json::parse(report::results_json(results)).at("doubts");
  REQUIRE(doubts.size() > 0);
  CHECK(doubts[0].get<std::string>().find("K/m = -0.367 ± 0.055 is below zero") != std::string::npos);
}

TEST_CASE("a quantity that the data do not determine is null, with the reason beside it") {
  core::AnalysisResults results = tests::made_results();
  results.configurations[0].mu = {std::nullopt, core::WhyUnknown{core::unknown::Told{"all clips move one way"}}};
  results.clips[0].segments[0].r2 = std::numeric_limits<double>::quiet_NaN();
  results.calibrations.clear();
  const json document = json::parse(report::results_json(results));
  CHECK(document.at("configurations").at(0).at("mu").is_null());
  CHECK(document.at("configurations").at(0).at("why").at("mu") == "all clips move one way");
  CHECK_FALSE(document.at("configurations").at(1).contains("why"));
  CHECK(document.at("clips").at(0).at("segments").at(0).at("r2").is_null());
  CHECK(document.at("clips").at(0).at("segments").at(0).at("why").contains("r2"));
  CHECK(document.at("calibration").is_null());
  CHECK(document.at("inclination").at("plumb_deg").is_null());
  CHECK(document.at("inclination").at("why").contains("plumb_deg"));
}

TEST_CASE("several groups have their plumb angles under their names, several folders their calibrations in a list") {
  core::AnalysisResults results = tests::made_results();
  results.configurations[1].group = "tilted";
  results.plumbs = {{"flat", tests::known(0.1, 0.2)},
                    {"tilted", {std::nullopt, core::WhyUnknown{core::unknown::Told{"no line in the region"}}}}};
  results.calibrations.push_back(results.calibrations.front());
  results.calibrations.back().experiment = "another";
  const json document = json::parse(report::results_json(results));
  const json& groups = document.at("inclination").at("groups");
  CHECK(groups.at("flat").at("plumb_deg").at("value") == 0.1);
  CHECK(groups.at("tilted").at("plumb_deg").is_null());
  CHECK(groups.at("tilted").at("why").at("plumb_deg") == "no line in the region");
  CHECK(document.at("calibrations").size() == 2);
  CHECK(document.at("calibrations").at(1).at("experiment") == "another");
}

TEST_CASE("names that hold quotes, tags or broken UTF-8 still make valid JSON") {
  core::AnalysisResults results = tests::made_results();
  results.clips[0].name = "a \"quoted\" <clip>\n";
  results.clips[1].notes = {core::HeightTaken{"broken \xff byte"}};
  const json document = json::parse(report::results_json(results));
  CHECK(document.at("clips").at(0).at("name") == "a \"quoted\" <clip>\n");
}

namespace {

std::vector<std::vector<std::string>> cells(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t from = 0; from < text.size();) {
    const auto end = text.find('\n', from);
    rows.emplace_back(1);
    for (std::size_t i = from; i < end; ++i) {
      if (text[i] == ',') {
        rows.back().emplace_back();
      } else {
        rows.back().back() += text[i];
      }
    }
    from = end + 1;
  }
  return rows;
}

}  // namespace

TEST_CASE("the motion's CSV has a row for every frame, units in its header, and residuals that add up") {
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.motion[3].smoothed = false;
  clip.motion[5].measured_m.reset();
  const auto rows = cells(report::motion_csv(clip));
  REQUIRE(rows.size() == clip.motion.size() + 1);
  for (const auto& row : rows) REQUIRE(row.size() == 12);
  CHECK(rows[0][0] == "t_s");
  CHECK(rows[0][4] == "residual_x_m");
  CHECK(rows[0][10] == "residual_a_m_s2");
  const auto& row = rows[101];
  const core::MotionPoint& point = clip.motion[100];
  CHECK(std::stod(row[4]) == *point.measured_m - point.x_m);  // the shortest text that reads back as the same double
  const core::LineFit& line = clip.segments[point.v_m_s > 0.0 ? 1 : 0];
  const double of_line = line.a0_m_s2.value - line.k_over_m_1_s.value * point.v_m_s;
  CHECK(std::stod(row[9]) == of_line);
  CHECK(std::stod(row[10]) == point.a_m_s2 - of_line);
  for (const int column : {2, 4, 5, 7, 9, 10}) CHECK(rows[4][static_cast<std::size_t>(column)].empty());
  CHECK(rows[6][1].empty());
  CHECK(rows[6][4].empty());
  CHECK_FALSE(rows[6][2].empty());
}

TEST_CASE("a clip with a known force has no residuals of a line in a(v)") {
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.forced = true;
  CHECK(cells(report::motion_csv(clip))[101][9].empty());
}

TEST_CASE("a motion that is not finite is an error, and its file bears the clip's name") {
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.motion[50].sd_x_m = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(report::motion_csv(clip), base::NumericalError);
  const core::AnalysisResults results = tests::made_results();
  CHECK(report::motion_file_names(results)[0] == "motion" + report::phase_file_names(results)[0].substr(5));
}

TEST_CASE("the CSV of a clip reads back as the smoothed motion, bit for bit") {
  const tests::TempDir temp;
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.motion[3].smoothed = false;
  base::write_file(temp / "phase.csv", report::phase_csv(clip));
  const base::CsvTable table = base::read_csv(temp / "phase.csv", {"t_s", "x_m", "v_m_s", "a_m_s2", "used"}, {}, true);
  REQUIRE(table.column("t_s").size() == clip.motion.size() - 1);
  CHECK(table.column("t_s")[3] == clip.motion[4].t_s);
  CHECK(table.column("x_m")[3] == clip.motion[4].x_m);
  CHECK(table.column("v_m_s")[100] == clip.motion[101].v_m_s);
  CHECK(table.column("a_m_s2")[100] == clip.motion[101].a_m_s2);
  CHECK(table.column("used")[0] == 0.0);
  CHECK(table.column("used")[100] == 1.0);
}

TEST_CASE("a smoothed value that is not finite is an error and not a row") {
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.motion[50].a_m_s2 = std::nan("");
  CHECK_THROWS_AS(report::phase_csv(clip), base::NumericalError);
}

TEST_CASE("a clip's name never leads out of the folder, and two clips never share a file") {
  core::AnalysisResults results = tests::made_results();
  results.clips[0].name = "../../etc/x";
  CHECK(report::phase_file_names(results)[0] == "phase-..%2F..%2Fetc%2Fx.csv");
  results.clips[0].name = results.clips[1].name = "run";
  results.clips[1].experiment = "second folder";
  CHECK(report::phase_file_names(results) ==
        std::vector<std::string>{"phase-made by hand-run.csv", "phase-second folder-run.csv"});
  results.clips[1].experiment = results.clips[0].experiment;
  CHECK(report::phase_file_names(results)[0] != report::phase_file_names(results)[1]);
}
