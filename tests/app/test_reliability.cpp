/// What a person's disk, names and impatience may do to the program: nothing half-written, one clear message.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "base/staged_output.h"
#include "catch.h"
#include "made_track.h"
#include "run_process.h"
#include "temp_dir.h"
#include "test_paths.h"
#include "tiny_scenario.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> names_in(const fs::path& dir) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(dir)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool says(const tests::ProcessResult& result, const std::string& part) {
  return result.err.find(part) != std::string::npos;
}

/// Permissions do not hold back root, who runs the tests in containers.
bool is_root() {
  return ::geteuid() == 0;
}

}  // namespace

TEST_CASE("folders whose names have spaces, UTF-8, quotes, or bytes that are no UTF-8 are analysed") {
  const tests::TempDir temp;
  for (const std::string& name :
       {std::string("with spaces"), std::string("Gleitbahn µ=0,007 日本"), std::string("a'b\"c$d;e&f"),
        std::string("-dash"), std::string("<b>"), std::string("latin\xe9")}) {
    INFO(name);
    tests::write_track_experiment(temp / name);
    const fs::path out = temp / (name + ".out");
    const tests::ProcessResult result =
        tests::glidelab({"analyze", (temp / name).string(), "--out", out.string(), "--json"});
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(base::read_file(out / "results.json") == result.out);
    CHECK(fs::exists(out / "report.html"));
  }
}

TEST_CASE("a relative --out with .. ends where the shell would end it, and leaves no staging folder") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  fs::create_directories(temp / "a/b");
  const tests::ProcessResult result =
      tests::glidelab({"analyze", "../../made", "-q", "--out", "../../out/./x/../y/"}, temp / "a/b");
  INFO(result.err);
  REQUIRE(result.status == 0);
  CHECK(fs::exists(temp / "out/y/results.json"));
  CHECK(names_in(temp / "out") == std::vector<std::string>{"y"});
  CHECK(names_in(temp / "a/b").empty());
}

TEST_CASE("experiment.toml reaches outside its folder with --allow-outside only") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  fs::rename(temp / "made/tracks", temp / "elsewhere");
  const std::string text = base::read_file(temp / "made/experiment.toml");
  std::string changed = text;
  changed.replace(changed.find("tracks/up.csv"), 13, "../elsewhere/up.csv");
  base::write_file(temp / "made/experiment.toml", changed);
  for (const char* command : {"analyze", "diagnose", "check"}) {
    INFO(command);
    const tests::ProcessResult refused =
        tests::glidelab({command, (temp / "made").string(), "-q", "--out", (temp / "out").string()});
    CHECK(refused.status == 1);
    CHECK(says(refused, "experiment.toml:"));
    CHECK(says(refused, "--allow-outside"));
    CHECK_FALSE(fs::exists(temp / "out"));
  }
  const tests::ProcessResult taken =
      tests::glidelab({"analyze", (temp / "made").string(), "-q", "--allow-outside", "--out", (temp / "out").string()});
  INFO(taken.err);
  CHECK(taken.status == 0);
}

TEST_CASE("an output folder in a read-only place is an error of the environment that names it") {
  if (is_root()) {
    WARN("skipped: root may write everywhere");
    return;
  }
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  fs::create_directories(temp / "locked");
  fs::permissions(temp / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  const tests::ProcessResult result =
      tests::glidelab({"analyze", (temp / "made").string(), "-q", "--out", (temp / "locked/out").string()});
  fs::permissions(temp / "locked", fs::perms::owner_all);
  CHECK(result.status == 3);
  CHECK(says(result, "locked"));
  CHECK(names_in(temp / "locked").empty());
}

TEST_CASE("a result on a full disk is an error of the environment") {
  if (!fs::exists("/dev/full")) {
    WARN("skipped: no /dev/full");
    return;
  }
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult result =
      tests::run({"sh", "-c", "\"$0\" analyze \"$1\" -q --json --out \"$2\" > /dev/full", tests::kBinary,
                  (temp / "made").string(), (temp / "out").string()});
  CHECK(result.status == 3);
  CHECK(says(result, "No space left"));
}

TEST_CASE("a file that may not grow further (a full quota) leaves no half-written folder") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml");
  // 8 blocks of 512 bytes: the first picture does not fit. SIGXFSZ is ignored, as under a quota write(2) then fails.
  const tests::ProcessResult result =
      tests::run({"sh", "-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" render \"$1\" -q --out \"$2\"", tests::kBinary,
                  (temp / "tiny.toml").string(), (temp / "out").string()});
  INFO(result.err);
  CHECK(result.status == 3);
  CHECK(names_in(temp.path()) == std::vector<std::string>{"tiny.toml"});
}

TEST_CASE("two analyses into one folder at the same time both succeed, and what stands is whole") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const std::vector<std::string> command = {tests::kBinary, "analyze", (temp / "made").string(),
                                            "-q",           "--out",   (temp / "out").string()};
  tests::Process first(command);
  tests::Process second(command);
  const tests::ProcessResult one = first.wait(), other = second.wait();
  INFO(one.err << other.err);
  CHECK(one.status == 0);
  CHECK(other.status == 0);
  CHECK(fs::exists(temp / "out/results.json"));
  CHECK(names_in(temp.path()) == std::vector<std::string>{"made", "out"});
}

TEST_CASE("killed at random instants, render leaves the folder that stood or a new one, and the next run is clean",
          "[slow]") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml");
  const std::vector<std::string> command = {tests::kBinary, "render", (temp / "tiny.toml").string(),
                                            "-q",           "--out",  (temp / "out").string()};
  REQUIRE(tests::run(command).status == 0);
  const std::string whole = base::read_file(temp / "out.truth/truth.json");
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    tests::Process run(command);
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 1500));
    run.send(SIGKILL);
    run.wait();
    CHECK(fs::exists(temp / "out/experiment.toml"));
    CHECK(base::read_file(temp / "out.truth/truth.json") == whole);
  }
  const tests::ProcessResult last = tests::run(command);
  INFO(last.err);
  CHECK(last.status == 0);
  CHECK(names_in(temp.path()) == std::vector<std::string>{"out", "out.truth", "tiny.toml"});
}

TEST_CASE("killed at random instants, analyze and diagnose leave whole files, and the next run is clean", "[slow]") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  std::mt19937 random(8);
  for (const std::string& name : {std::string("analyze"), std::string("diagnose")}) {
    const std::vector<std::string> command = {tests::kBinary, name,    (temp / "made").string(),
                                              "-q",           "--out", (temp / name).string()};
    const fs::path result = temp / name / (name == "analyze" ? "results.json" : "diagnosis.json");
    REQUIRE(tests::run(command).status == 0);
    const std::string whole = base::read_file(result);
    for (int i = 0; i < 20; ++i) {
      tests::Process run(command);
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % 1000));
      run.send(SIGKILL);
      run.wait();
      CHECK(base::read_file(result) == whole);
    }
    REQUIRE(tests::run(command).status == 0);
  }
  CHECK(names_in(temp.path()) == std::vector<std::string>{"analyze", "diagnose", "made"});
}
