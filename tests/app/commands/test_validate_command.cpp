/// `glidelab validate`: the whole loop as a user sees it.
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/small_scenario.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"

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

TEST_CASE("a gate of few runs says how little it finds, and takes no other noise than its baseline's") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", tests::kSweptScenario);
  const std::string scenario = dir / "s.toml", file = dir / "b.json";
  const auto validate = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"validate", scenario, "--runs", "10"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return tests::glidelab(arguments, dir.path());
  };
  REQUIRE(validate({"--write-baseline", file, "--noise-m", "3e-5"}).status == 0);
  const tests::ProcessResult other = validate({"--baseline", file, "--noise-m", "2e-5"});
  CHECK(other.status == 1);
  CHECK(other.err.find("--noise-m: found 2e-05, expected 3e-05, as for the baseline") != std::string::npos);
  const tests::ProcessResult same = validate({"--baseline", file, "--noise-m", "3e-5"});
  INFO(same.err);
  CHECK(same.err.find("smallest worsening that is detected with probability 0.95, and the number of runs, in the "
                      "baseline and now, that detect errors 1.1 times as large") != std::string::npos);
  // Of normal errors 10 runs find no factor at all: 4.7 (the level's z and that of 0.9) times 0.603 / sqrt(10) is more
  // than 0.798, the mean of |z|.
  CHECK(same.err.find("not detected") != std::string::npos);
  CHECK(same.err.find("warning: a weak gate: for ") != std::string::npos);
  CHECK(same.err.find("(--runs), suffice for a factor of 1.5") != std::string::npos);
  const tests::ProcessResult alone = tests::glidelab({"validate", scenario, "--noise-m", "3e-5"}, dir.path());
  CHECK(alone.status == 2);
  CHECK(alone.err.find("--noise-m requires --baseline or --write-baseline") != std::string::npos);
}

TEST_CASE("a baseline is never compared with its own noise, nor written over by what it is compared with") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", tests::kSweptScenario);
  const auto validate = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"validate", "s.toml", "--runs", "10", "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return tests::glidelab(arguments, dir.path());
  };
  for (const std::string seed : {"1", "2"}) {
    INFO(seed);
    fs::remove(dir / "then.json");
    REQUIRE(validate({"--write-baseline", "then.json", "--seed", seed}).status == 0);
    const std::string then = base::read_file(dir / "then.json");
    CHECK(json::parse(then).at("seed") == std::stoi(seed));
    const tests::ProcessResult now = validate({"--baseline", "then.json", "--write-baseline", "now.json"});
    REQUIRE((now.status == 0 || now.status == 4));
    const json found = json::parse(base::read_file(dir / "now.json"));
    CHECK(found.at("seed") != json::parse(then).at("seed"));
    CHECK(found.at("records") != json::parse(then).at("records"));
    const tests::ProcessResult same = validate({"--baseline", "then.json", "--seed", seed});
    CHECK(same.status == 1);
    CHECK(same.err.find("--seed: found " + seed + ", with which the baseline was made") != std::string::npos);
    const tests::ProcessResult both = validate({"--baseline", "then.json", "--write-baseline", "./then.json"});
    CHECK(both.status == 1);
    CHECK(both.err.find("found the file of --baseline") != std::string::npos);
    CHECK(base::read_file(dir / "then.json") == then);
  }
  CHECK(validate({"--write-baseline", "x.json", "--noise-m", "nan"}).status == 2);
}

TEST_CASE("a baseline that cannot be written is said before the first run") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", tests::kSweptScenario);
  fs::create_directory(dir / "folder");
  for (const char* file : {"none/b.json", "s.toml/b.json", "folder"}) {
    const tests::ProcessResult result =
        tests::glidelab({"validate", "s.toml", "--runs", "10", "--write-baseline", file}, dir.path());
    INFO(file << ": " << result.err);
    CHECK(result.status == 3);
    CHECK(result.err.find(std::string(file) + ": cannot be written") != std::string::npos);
    CHECK(result.err.find("runs:") == std::string::npos);
    CHECK(result.out.empty());
  }
}

TEST_CASE("coverage with a noise that is given asks no camera, and counts at the levels that are asked for") {
  const tests::TempDir dir;
  std::string text = tests::kSweptScenario;
  text.insert(text.find("position_m"), "target_m = [5.0, 0.1, 0.0]\n");  // looks at the wall beside the track
  base::write_file(dir / "s.toml", tests::kSweptScenario);
  base::write_file(dir / "aside.toml", text);
  const tests::ProcessResult result = tests::glidelab({"coverage", "aside.toml", "--noise-m", "2e-5", "--replicates",
                                                       "5", "--level", "50", "99.5", "--json", "-q", "-o", "out"},
                                                      dir.path());
  INFO(result.err);
  REQUIRE((result.status == 0 || result.status == 4));
  const nlohmann::json found = nlohmann::json::parse(result.out);
  CHECK(found["levels"] == nlohmann::json({0.5, 0.995}));
  for (const nlohmann::json& quantity : found["quantities"]) {
    REQUIRE(quantity["levels"].size() == 2);
    CHECK(quantity["levels"][0]["covered"] <= quantity["levels"][1]["covered"]);
  }
  const tests::ProcessResult seen = tests::glidelab({"coverage", "aside.toml", "--replicates", "5"}, dir.path());
  CHECK(seen.status == 1);
  CHECK(seen.err.find("never in the image") != std::string::npos);
  const tests::ProcessResult wrong =
      tests::glidelab({"coverage", "s.toml", "--noise-m", "2e-5", "--replicates", "5", "--level", "100"}, dir.path());
  CHECK(wrong.status == 2);
  CHECK(wrong.err.find("\"100\" is not a percentage above 0 and below 100") != std::string::npos);
}

TEST_CASE("coverage refuses numbers that mean nothing before it begins, and says where a bandwidth leaves no value") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", tests::kSweptScenario);
  const auto coverage = [&](const std::string& option, const std::string& value) {
    std::vector<std::string> arguments = {"coverage", "s.toml", "-q"};
    if (option != "--noise-m") arguments.insert(arguments.end(), {"--noise-m", "2e-5"});
    if (option != "--replicates") arguments.insert(arguments.end(), {"--replicates", "5"});
    arguments.push_back(option + "=" + value);
    return tests::glidelab(arguments, dir.path());
  };
  for (const auto& [option, values] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"--replicates", {"-1", "0", "1000000000000", "1.5"}},
           {"--bandwidth", {"-1", "0", "nan", "inf", "wide"}},
           {"--level", {"0", "100", "-5", "nan"}},
           {"--noise-m", {"-1", "0", "nan", "inf"}}}) {
    for (const std::string& value : values) {
      const tests::ProcessResult result = coverage(option, value);
      INFO(option << " " << value << ": " << result.err);
      CHECK(result.status == 2);
      CHECK(result.err.find(option) != std::string::npos);
    }
  }
  // 1 s in a clip of 1.2 s: no point is free of the clip's ends. More than the clip lasts is wrong input.
  const tests::ProcessResult wide = coverage("--bandwidth", "1");
  CHECK(wide.status == 4);
  CHECK(wide.err.find("with --bandwidth 1 the phase diagram finds no value") != std::string::npos);
  const tests::ProcessResult wider = coverage("--bandwidth", "100");
  CHECK(wider.status == 1);
  CHECK(wider.err.find("bandwidth: found 100 s, expected at most 1.") != std::string::npos);
}
