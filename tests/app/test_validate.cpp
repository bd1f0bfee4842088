/// `glidelab validate`: the whole loop as a user sees it.
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/staged_output.h"
#include "catch.h"
#include "run_process.h"
#include "small_scenario.h"
#include "temp_dir.h"
#include "test_paths.h"

using namespace glidelab;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::size_t entries(const fs::path& dir) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(dir), fs::directory_iterator{}));
}

}  // namespace

TEST_CASE("validate writes all its files, prints comparison.json with --json, and a page that needs nothing else") {
  const tests::TempDir temp;
  base::write_file(temp / "small.toml", tests::kSmallScenario);
  const tests::ProcessResult result =
      tests::glidelab({"validate", "small.toml", "--out", "out", "--json"}, temp.path());
  INFO(result.err);
  REQUIRE(result.status == 0);
  CHECK(entries(temp.path()) == 2);
  for (const char* file :
       {"results.json", "comparison.json", "report.html", "phase-up.csv", "phase-down.csv", "trajectory-up.csv",
        "trajectory-down.csv", "experiment/experiment.toml", "experiment.truth/truth.json"}) {
    INFO(file);
    CHECK(fs::exists(temp / "out" / file));
  }
  CHECK(base::read_file(temp / "out/trajectory-up.csv") ==
        base::read_file(temp / "out/experiment.truth/trajectory-up.csv"));

  const json document = json::parse(result.out);
  CHECK(result.out == base::read_file(temp / "out/comparison.json"));
  REQUIRE(document.at("quantities").size() == 8);
  for (const json& quantity : document.at("quantities")) {
    for (const char* key :
         {"configuration", "mass_kg", "incline_deg", "estimator", "quantity", "truth", "value", "sd", "error"}) {
      INFO(key);
      CHECK_FALSE(quantity.at(key).is_null());
    }
  }
  CHECK(document.at("frames") == 290);
  CHECK(document.at("detected") == 290);
  CHECK(document.at("wall_s").get<double>() > 0.0);
  CHECK(document.at("restitution").at("field_m").get<double>() > 0.5);

  const std::string page = base::read_file(temp / "out/report.html");
  CHECK(page.find("src=\"http") == std::string::npos);
  CHECK(page.find("data:image/jpeg;base64,") != std::string::npos);
  CHECK(page.size() < 10'000'000);

  SECTION("analyze finds the same in the experiment that it wrote, without the truth") {
    fs::remove_all(temp / "out/experiment.truth");
    const tests::ProcessResult analysed =
        tests::glidelab({"analyze", "out/experiment", "--out", "again", "-q"}, temp.path());
    INFO(analysed.err);
    CHECK(analysed.status == 0);
    CHECK(base::read_file(temp / "again/results.json") == base::read_file(temp / "out/results.json"));
  }
}

TEST_CASE("validate refuses to replace an experiment folder that is somebody's own") {
  const tests::TempDir temp;
  base::write_file(temp / "small.toml", tests::kSmallScenario);
  fs::create_directories(temp / "out/experiment");
  base::write_file(temp / "out/experiment/thesis.txt", "mine");
  const tests::ProcessResult result = tests::glidelab({"validate", "small.toml", "--out", "out"}, temp.path());
  CHECK(result.status == 1);
  CHECK(base::read_file(temp / "out/experiment/thesis.txt") == "mine");
}

TEST_CASE("an interrupt ends validation with status 130 and leaves nothing behind") {
  const tests::TempDir temp;
  base::write_file(temp / "small.toml", tests::kSmallScenario);
  tests::Process process({tests::kBinary, "validate", "small.toml", "--out", "out"}, temp.path());
  for (int tries = 0; tries < 500 && entries(temp.path()) == 1; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  REQUIRE(entries(temp.path()) == 2);  // the staging folder
  process.send(SIGINT);
  const tests::ProcessResult result = process.wait();
  CHECK(result.status == 130);
  CHECK(entries(temp.path()) == 1);
}
