#include "report/diagnosis/diagnosis_json.h"

#include <nlohmann/json.hpp>

#include "tests/catch.h"
#include "tests/report/made_diagnoses.h"

using namespace glidelab;

namespace {

nlohmann::json json_of(const diagnose::Diagnosis& diagnosis) {
  return nlohmann::json::parse(report::diagnosis_json(diagnosis));
}

}  // namespace

TEST_CASE("a parameter that is a word has a value and no standard deviation") {
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::effect;
  diagnosis.effects.push_back(
      {"compression", diagnose::Stage::sensor, "", 0.9, {}, {{"codec", 0.0, 0.0, "MJPG"}, {"e", 2.0, 0.5}}});
  std::string json = report::diagnosis_json(diagnosis);
  std::erase_if(json, [](unsigned char c) { return c == ' ' || c == '\n'; });
  CHECK(json.find("\"codec\":{\"value\":\"MJPG\"}") != std::string::npos);
  CHECK(json.find("\"e\":{\"value\":2.0,\"sd\":0.5}") != std::string::npos);
}

TEST_CASE(
    "the file has the sequence of causes, what is left, the levels and the recovered quantities under their keys") {
  const nlohmann::json file = json_of(tests::two_causes());
  const auto& drag = file.at("explained").at(0);
  CHECK(drag.at("id") == "quadratic_drag");
  CHECK(drag.at("share") == 0.91);
  CHECK(drag.at("share_interval95") == nlohmann::json({0.86, 0.95}));
  CHECK(drag.at("gap_after").get<double>() == Approx(tests::gap_with_left(5.3, 0.09)));
  CHECK(file.at("explained").at(1).at("id") == "rotational_inertia");
  const auto& left = file.at("remainder");
  CHECK(left.at("share") == 0.03);
  CHECK(left.at("gap").get<double>() == Approx(tests::gap_with_left(5.3, 0.03)));
  CHECK(left.at("acceleration_m_s2") == 4.1e-3);
  CHECK(left.at("clip_scatter_m_s2") == 8e-4);
  CHECK(left.at("drag_scatter") == 0.021);
  const auto& region = left.at("where").at("regions").at(0);
  CHECK(region.at("variable") == "t_s");
  CHECK(region.at("to") == 0.1);
  CHECK(region.at("size") == 1.2e-3);
  CHECK(region.at("size_sd") == 1e-4);
  CHECK(file.at("traces") == nlohmann::json::array());
  CHECK(file.at("levels") ==
        nlohmann::json({{"clip", 5.1}, {"configuration", 5.28}, {"all", 5.3}, {"holds_within", false}}));
  const auto& first = file.at("recovered").at(0);
  CHECK(first.at("group") == "slope");
  CHECK(first.at("mass_kg") == 0.335);
  CHECK(first.at("incline_deg") == 4.0);
  CHECK(first.at("with") == nlohmann::json({"quadratic_drag", "rotational_inertia"}));
  CHECK(first.at("mu").at("value") == 0.0071);
  CHECK(first.at("mu").at("sd") == 0.0001);
  CHECK(first.at("mu").at("interval95").size() == 2);
  for (const char* key : {"k_over_m_1_s", "alpha_deg", "v_lim_m_s"}) CHECK(first.at(key).contains("value"));
  const auto& second = file.at("recovered").at(1);
  CHECK(second.at("v_lim_m_s").is_null());
  CHECK(second.at("why").at("v_lim_m_s") == "the clips hold no motion downhill");
}

TEST_CASE("what a sequence of causes has not is empty or null in the file, with the reason where there is one") {
  const nlohmann::json nothing = json_of({});
  for (const char* key : {"explained", "traces", "recovered"}) CHECK(nothing.at(key) == nlohmann::json::array());
  for (const char* key : {"remainder", "levels"}) CHECK(nothing.at(key).is_null());
  diagnose::Diagnosis of = tests::two_causes();
  of.explained.front().share_interval95.reset();
  of.gap->interval95 = {};
  of.gap->interval95.too_few = 2;
  of.levels = diagnose::GapLevels{};
  of.traces = {"timestamp_jitter"};
  const nlohmann::json file = json_of(of);
  CHECK(file.at("explained").at(0).at("share_interval95").is_null());
  CHECK(file.at("explained").at(0).at("why").at("share_interval95") ==
        "2 clips cannot show how much clips differ: an interval needs three or more");
  CHECK(file.at("levels").at("clip").is_null());
  CHECK(file.at("levels").at("why").at("configuration") == "there is one configuration alone");
  CHECK(file.at("traces") == nlohmann::json({"timestamp_jitter"}));
}
