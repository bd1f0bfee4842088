#include "report/check/check_report.h"

#include <nlohmann/json.hpp>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("check.json says how far the glider goes in each clip, of pictures and of a track alike") {
  core::RecordingCheck check;
  check.clips.resize(2);
  check.clips[0].pictures = true;
  check.clips[0].distance_m = 0.75;
  check.clips[1].distance_m = 1.25;
  const auto json = nlohmann::json::parse(report::check_json(check));
  CHECK(json["clips"][0]["way_m"] == 0.75);
  CHECK(json["clips"][1]["way_m"] == 1.25);
}
