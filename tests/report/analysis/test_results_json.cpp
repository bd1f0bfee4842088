#include "report/analysis/result_files.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/catch.h"
#include "tests/report/made_results.h"

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
