#include "report/diagnosis/diagnosis_json.h"

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("a parameter that is a word has a value and no standard deviation") {
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::effect;
  diagnosis.effects.push_back({"compression", "sensor", "", 0.9, {}, {{"codec", 0.0, 0.0, "MJPG"}, {"e", 2.0, 0.5}}});
  std::string json = report::diagnosis_json(diagnosis);
  std::erase_if(json, [](unsigned char c) { return c == ' ' || c == '\n'; });
  CHECK(json.find("\"codec\":{\"value\":\"MJPG\"}") != std::string::npos);
  CHECK(json.find("\"e\":{\"value\":2.0,\"sd\":0.5}") != std::string::npos);
}
