#include "validate/truth/truth_folder.h"

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using nlohmann::json;

namespace {

json made_document() {
  return {{"format", 1},
          {"name", "made"},
          {"seed", 7},
          {"configurations",
           {{{"name", "m1"},
             {"mass_kg", 0.335},
             {"stated_incline_deg", 4.0},
             {"group", "flat"},
             {"k_over_m_1_s", 2.768},
             {"mu", nullptr},
             {"alpha_deg", 4.311},
             {"v_lim_m_s", nullptr},
             {"clips", {"m1-up"}}}}},
          {"clips",
           {{{"name", "m1-up"},
             {"configuration", "m1"},
             {"frames", 2},
             {"x_origin_m", -0.1},
             {"trajectory", "trajectory-m1-up.csv"}}}},
          {"camera", {{"anything", 1}}}};
}

class TruthFolder {
 public:
  explicit TruthFolder(const json& document,
                       const std::string& rows = "0,0.1,1,0,slide_down\n0.005,0.105,1,0,stick\n") {
    base::write_file(temp_ / "truth.json", document.dump());
    base::write_file(temp_ / "trajectory-m1-up.csv", "t_s,x_m,v_m_s,a_m_s2,mode\n" + rows);
  }
  validate::Truth read() const { return validate::read_truth(temp_.path()); }

 private:
  tests::TempDir temp_;
};

/// The message of the InputError that reading throws, or nothing.
std::string message_of(const TruthFolder& folder) {
  try {
    folder.read();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a truth folder reads as it was written") {
  const validate::Truth truth = TruthFolder(made_document()).read();
  CHECK(truth.name == "made");
  CHECK(truth.seed == 7);
  REQUIRE(truth.configurations.size() == 1);
  CHECK(truth.configurations[0].k_over_m_1_s == 2.768);
  CHECK_FALSE(truth.configurations[0].mu);
  CHECK(truth.configurations[0].alpha_deg == 4.311);
  CHECK(truth.configurations[0].clips == std::vector<std::string>{"m1-up"});
  REQUIRE(truth.clips.size() == 1);
  CHECK(truth.clips[0].x_origin_m == -0.1);
  CHECK(truth.clips[0].x_m == std::vector<double>{0.1, 0.105});
  CHECK(truth.clips[0].t_s == std::vector<double>{0.0, 0.005});
}

TEST_CASE("a missing or mistyped key of truth.json is an error that names file and key") {
  json document = made_document();
  document["configurations"][0].erase("mass_kg");
  document["clips"][0]["frames"] = -2;
  const std::string message = message_of(TruthFolder(document));
  CHECK(message.find("truth.json: configurations[0].mass_kg: found nothing") != std::string::npos);
  CHECK(message.find("clips[0].frames: found -2") != std::string::npos);
}

TEST_CASE("a truth of another format, without clips, or that contradicts itself is an error") {
  json document = made_document();
  document["format"] = 2;
  CHECK_FALSE(message_of(TruthFolder(document)).empty());
  document = made_document();
  document["clips"] = json::array();
  CHECK_FALSE(message_of(TruthFolder(document)).empty());
  document = made_document();
  document["clips"][0]["configuration"] = "m9";
  CHECK(message_of(TruthFolder(document)).find("clips[0].configuration: found \"m9\"") != std::string::npos);
  document = made_document();
  document["clips"].push_back(document["clips"][0]);
  CHECK(message_of(TruthFolder(document)).find("twice") != std::string::npos);
  document = made_document();
  document["clips"][0]["trajectory"] = "../trajectory-m1-up.csv";
  CHECK(message_of(TruthFolder(document)).find("clips[0].trajectory") != std::string::npos);
}

TEST_CASE("a trajectory with a row too few is an error that names its file") {
  const std::string message = message_of(TruthFolder(made_document(), "0,0.1,1,0,slide_down\n"));
  CHECK(message.find("trajectory-m1-up.csv") != std::string::npos);
  CHECK(message.find("1 rows") != std::string::npos);
}

TEST_CASE("a truth that is no JSON, or no folder, is an input error") {
  const tests::TempDir temp;
  CHECK_THROWS_AS(validate::read_truth(temp / "nothing"), base::InputError);
  base::write_file(temp / "truth.json", "{\"format\": 1,");
  CHECK_THROWS_AS(validate::read_truth(temp.path()), base::InputError);
  base::write_file(temp / "truth.json", "[1, 2]");
  CHECK_THROWS_AS(validate::read_truth(temp.path()), base::InputError);
}
