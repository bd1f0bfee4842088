/// glidelab new.
#include <nlohmann/json.hpp>

#include "base/files/file_io.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

TEST_CASE("new makes a folder whose experiment.toml lacks only the recording") {
  const tests::TempDir temp;
  const tests::ProcessResult made = tests::glidelab({"new", "my glider"}, temp.path());
  INFO(made.err);
  CHECK(made.status == 0);
  for (const char* name : {"experiment.toml", "README.md", "clips", "calibration"}) {
    CHECK(fs::exists(temp / "my glider" / name));
  }
  CHECK(base::read_file(temp / "my glider/experiment.toml").starts_with("format = 1\nname = \"my glider\"\n"));
  const tests::ProcessResult analysed = tests::glidelab({"analyze", "my glider"}, temp.path());
  CHECK(analysed.status == 1);
  CHECK(analysed.err.find("clips/m1-up.mp4") != std::string::npos);
  CHECK(analysed.err.find("unknown key") == std::string::npos);
}

TEST_CASE("new leaves a folder with files alone, and takes an empty one") {
  const tests::TempDir temp;
  fs::create_directories(temp / "full");
  base::write_file(temp / "full/notes.txt", "mine");
  const tests::ProcessResult refused = tests::glidelab({"new", "full"}, temp.path());
  CHECK(refused.status == 1);
  CHECK(refused.err.find("full: found a folder that is not empty") != std::string::npos);
  CHECK(base::read_file(temp / "full/notes.txt") == "mine");
  CHECK_FALSE(fs::exists(temp / "full/experiment.toml"));
  fs::create_directories(temp / "empty");
  CHECK(tests::glidelab({"new", "empty", "-q"}, temp.path()).status == 0);
  CHECK(fs::exists(temp / "empty/experiment.toml"));
  CHECK(tests::glidelab({"new", "empty"}, temp.path()).status == 1);
  CHECK(tests::glidelab({"new", "full/notes.txt"}, temp.path()).status == 1);
}

TEST_CASE("new takes its folder once, as FOLDER or as --out") {
  const tests::TempDir temp;
  CHECK(tests::glidelab({"new"}, temp.path()).status == 2);
  CHECK(tests::glidelab({"new", "a", "-o", "b"}, temp.path()).status == 2);
  const tests::ProcessResult made = tests::glidelab({"new", "-o", "b", "--json"}, temp.path());
  CHECK(made.status == 0);
  CHECK(nlohmann::json::parse(made.out).at("files").size() == 2);
  CHECK(fs::exists(temp / "b/experiment.toml"));
}

TEST_CASE("new refuses a name that is no UTF-8, which no experiment.toml can hold") {
  const tests::TempDir temp;
  CHECK(tests::glidelab({"new", "bad\xff"}, temp.path()).status == 1);
  CHECK_FALSE(fs::exists(temp / "bad\xff"));
}
