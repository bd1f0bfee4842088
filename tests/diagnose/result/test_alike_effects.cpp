#include "diagnose/result/diagnosis.h"

#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

namespace {

diagnose::Diagnosis named(const std::vector<std::string>& equivalent_to) {
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::effect;
  diagnosis.effects.push_back(
      {"scale_error", diagnose::Stage::optics, "a wrong length scale", 0.30, equivalent_to, {}, 0.0, {}});
  return diagnosis;
}

const std::vector<diagnose::NamedExplanation> kExplanations = {{{"direction_asymmetry"}, 0.44},
                                                               {{"scale_error"}, 0.25},
                                                               {{"frame_rate_error"}, 0.24},
                                                               {{"scale_error", "direction_asymmetry"}, 0.05},
                                                               {{"stribeck"}, 0.01},
                                                               {{}, 0.01}};

std::string words(const std::string& id) {
  return "words of " + id;
}

}  // namespace

TEST_CASE("effects that look the same are counted together, a pair of them once, and the likeliest leads") {
  diagnose::Diagnosis diagnosis = named({"frame_rate_error", "direction_asymmetry"});
  diagnose::join_alike(kExplanations, words, diagnosis);
  const diagnose::DiagnosedEffect& effect = diagnosis.effects.front();
  CHECK(std::abs(effect.joint_probability - 0.98) < 1e-12);  // 0.44 + 0.25 + 0.24 + 0.05
  REQUIRE(effect.alike.size() == 3);
  CHECK(effect.alike[0].id == "direction_asymmetry");
  CHECK(std::abs(*effect.alike[0].probability - 0.49) < 1e-12);
  CHECK(effect.alike[1].id == "scale_error");
  CHECK(std::abs(*effect.alike[1].probability - 0.30) < 1e-12);
  CHECK(effect.alike[2].id == "frame_rate_error");
  CHECK(effect.alike[0].words == "words of direction_asymmetry");
  CHECK(effect.id == "scale_error");  // by the rule of the verdict
}

TEST_CASE("an effect that stands alone keeps its own probability, and one that was not weighed has none") {
  diagnose::Diagnosis alone = named({}), lines = named({"eddy_rolloff"});
  diagnose::join_alike(kExplanations, words, alone);
  CHECK(alone.effects.front().joint_probability == 0.30);
  CHECK(alone.effects.front().alike.empty());
  diagnose::join_alike(kExplanations, words, lines);
  REQUIRE(lines.effects.front().alike.size() == 2);
  CHECK_FALSE(lines.effects.front().alike.back().probability);
  CHECK(std::abs(lines.effects.front().joint_probability - 0.30) < 1e-12);
}
