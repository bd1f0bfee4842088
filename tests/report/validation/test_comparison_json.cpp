#include "report/validation/validation_report.h"

#include <nlohmann/json.hpp>

#include "tests/catch.h"

using namespace glidelab;
using nlohmann::json;

TEST_CASE("comparison.json has every key of its form, and what is missing is null with a reason") {
  validate::Comparison comparison;
  const core::WhyUnknown level{core::unknown::Told{"level"}};
  comparison.quantities = {
      {"m1", 0.335, 4.0, "phase-diagram", "k_over_m_1_s", 2.76, 2.763, 0.004, 0.003, {}},
      {"m1", 0.335, 4.0, "phase-diagram", "v_lim_m_s", std::nullopt, std::nullopt, std::nullopt, std::nullopt, level},
      {"m1", 0.335, 4.0, "phase-diagram", "mu", std::nullopt, 0.001, 0.002, std::nullopt, {}}};
  comparison.lines = {{"m1-up", -1, 0.9999}};
  comparison.restitution = {1.1e-5, 4e-5, 1.6, {{0, 0.0, 0.1, 1.1e-5}}};
  comparison.frames = 4100;
  comparison.detected = 4099;
  comparison.wall_s = 41.2;
  const json document = json::parse(report::comparison_json(comparison));
  CHECK(document.at("format") == 1);
  const json& quantity = document.at("quantities").at(0);
  CHECK(quantity.at("configuration") == "m1");
  CHECK(quantity.at("mass_kg") == 0.335);
  CHECK(quantity.at("incline_deg") == 4.0);
  CHECK(quantity.at("estimator") == "phase-diagram");
  CHECK(quantity.at("quantity") == "k_over_m_1_s");
  CHECK(quantity.at("truth") == 2.76);
  CHECK(quantity.at("value") == 2.763);
  CHECK(quantity.at("sd") == 0.004);
  CHECK(quantity.at("error") == 0.003);
  CHECK(document.at("quantities").at(1).at("value").is_null());
  CHECK(document.at("quantities").at(1).at("why").at("value") == "level");
  CHECK(document.at("quantities").at(2).at("error").is_null());
  CHECK(document.at("quantities").at(2).at("value") == 0.001);
  CHECK(document.at("lines").at(0) == json({{"clip", "m1-up"}, {"direction", -1}, {"r2", 0.9999}}));
  CHECK(document.at("restitution").at("rms_m") == 1.1e-5);
  CHECK(document.at("restitution").at("max_m") == 4e-5);
  CHECK(document.at("restitution").at("field_m") == 1.6);
  CHECK(document.at("frames") == 4100);
  CHECK(document.at("detected") == 4099);
  CHECK(document.at("wall_s") == 41.2);
}
