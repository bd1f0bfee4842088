#include <filesystem>
#include <string>

#include "base/files/file_io.h"
#include "nlohmann/json.hpp"
#include "tests/app/made_track.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

TEST_CASE("certify writes its answer first, and the same file and page whatever the number of threads") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult one =
      tests::glidelab({"certify", "made", "--twins", "20", "-q", "-o", "one", "--jobs", "1"}, temp.path());
  const tests::ProcessResult two =
      tests::glidelab({"certify", "made", "--twins", "20", "-q", "-o", "two", "--jobs", "3"}, temp.path());
  INFO(one.err);
  REQUIRE((one.status == 0 || one.status == 4));
  CHECK(two.status == one.status);
  CHECK(one.out == two.out);
  CHECK(base::read_file(temp / "one/certify.json") == base::read_file(temp / "two/certify.json"));
  CHECK(base::read_file(temp / "one/report.html") == base::read_file(temp / "two/report.html"));
  const auto json = nlohmann::json::parse(base::read_file(temp / "one/certify.json"));
  CHECK(one.out.starts_with(json["answer"].get<std::string>() + "\n"));
  CHECK(json["twins"] == 20);
  CHECK(json["by"] == "tracks");
  CHECK(json["holds"] == (one.status == 0));
  CHECK(json["quantities"].size() == 4);
}

TEST_CASE("certify takes a track's file on its own, with the options that analyze has for it") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult result = tests::glidelab({"certify", "made/tracks/up.csv", "--mass", "0.335", "--incline",
                                                       "4", "--twins", "20", "--json", "-q", "-o", "out"},
                                                      temp.path());
  INFO(result.err);
  REQUIRE((result.status == 0 || result.status == 4));
  CHECK(nlohmann::json::parse(result.out)["clips"] == 1);
  CHECK(base::read_file(temp / "out/certify.json") == result.out);
}

TEST_CASE("certify refuses what has no motions, a scenario, and too few twins, with one error and no file") {
  const tests::TempDir temp;
  base::write_file(temp / "lines.csv",
                   "mass_kg,direction,k_over_m_1_s,a0_m_s2\n0.3,-1,2.7,0.07\n0.3,1,2.7,0.06\n0.5,-1,1.7,0.07\n");
  base::write_file(temp / "scenario.toml", "format = 1\nname = \"s\"\n[[configuration]]\nname = \"m\"\n");
  tests::write_track_experiment(temp / "made");
  const auto refused = [&](const std::vector<std::string>& arguments, int status, const std::string& says) {
    const tests::ProcessResult result = tests::glidelab(arguments, temp.path());
    INFO(result.err);
    CHECK(result.status == status);
    CHECK(result.out.empty());
    CHECK(result.err.starts_with("glidelab: error: "));
    CHECK(result.err.find("error: ", 10 + std::string("error: ").size()) == std::string::npos);
    CHECK(result.err.find(says) != std::string::npos);
    CHECK_FALSE(fs::exists(temp / "out"));
  };
  refused({"certify", "lines.csv", "-q", "-o", "out"}, 1, "a table of lines");
  refused({"certify", "scenario.toml", "-q", "-o", "out"}, 1, "scenario");
  refused({"certify", "made", "--twins", "5", "-q", "-o", "out"}, 2, "--twins");
  refused({"certify", "made", "--mass", "1", "-q", "-o", "out"}, 1, "experiment.toml");
}
