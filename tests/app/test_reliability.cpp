/// What a person's disk, names and impatience may do to the program: nothing half-written, one clear message.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/app/left_behind.h"
#include "tests/app/made_track.h"
#include "tests/app/run_process.h"
#include "tests/app/tiny_scenario.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;
using tests::names_in;
using tests::says;

namespace {

/// Permissions do not hold back root, who runs the tests in containers: nobody then runs the program.
tests::User held_back_by_permissions() {
  return ::geteuid() == 0 ? tests::User::nobody : tests::User::same;
}

/// Whether that user can run the program at all: a checkout below somebody's home may be closed to others.
bool can_run(tests::User user) {
  return tests::run({tests::kBinary, "--version"}, "/", user).status == 0;
}

/// Everybody may read what is in a test's folder.
void open_to_all(const fs::path& folder) {
  constexpr fs::perms kRead = fs::perms::group_read | fs::perms::others_read;
  constexpr fs::perms kEnter = fs::perms::group_exec | fs::perms::others_exec;
  fs::permissions(folder, kRead | kEnter, fs::perm_options::add);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    fs::permissions(entry.path(), entry.is_directory() ? kRead | kEnter : kRead, fs::perm_options::add);
  }
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

TEST_CASE("results do not go among what they are made of, by whatever name the folder is called") {
  const tests::TempDir temp;
  fs::create_directories(temp / "track/clips");
  base::write_file(temp / "track/experiment.toml", "no TOML =\n");  // nothing is read before
  fs::create_directories(temp / "camera");
  base::write_file(temp / "camera/characterize.toml", "no TOML =\n");
  fs::create_directory_symlink("track", temp / "link");
  const std::vector<std::string> before = names_in(temp / "track");
  for (const char* name : {"track", "track/", "track/.", "track/clips/..", "link", "./link/../track"}) {
    for (const char* command : {"analyze", "check", "diagnose"}) {
      const tests::ProcessResult refused = tests::glidelab({command, "track", "-o", name}, temp.path());
      INFO(command << " -o " << name << ": " << refused.err);
      CHECK(refused.status == 2);
      CHECK(says(refused, "--out: found a recording (experiment.toml)"));
      CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
    }
  }
  CHECK(tests::glidelab({"diagnose", "track", "--plan", "-o", "track"}, temp.path()).status == 2);
  CHECK(tests::glidelab({"characterize", "camera", "-o", "camera"}, temp.path()).status == 2);
  CHECK(tests::glidelab({"explore", "-o", "camera"}, temp.path()).status == 2);
  CHECK(names_in(temp / "track") == before);
  CHECK(names_in(temp / "camera") == std::vector<std::string>{"characterize.toml"});
  CHECK(names_in(temp.path()) == std::vector<std::string>{"camera", "link", "track"});
}

TEST_CASE("results may go into a folder of their own inside the recording's, as the default does there") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "r");
  CHECK(tests::glidelab({"analyze", "r", "-q", "-o", "r/results"}, temp.path()).status == 0);
  CHECK(fs::exists(temp / "r/results/results.json"));
  CHECK(tests::glidelab({"analyze", ".", "-q"}, temp / "r").status == 0);
  CHECK(fs::exists(temp / "r/glidelab-out/analyze-r/results.json"));
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
  const tests::User user = held_back_by_permissions();
  if (!can_run(user)) {
    WARN("skipped: nobody may not run the program where it lies");
    return;
  }
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  fs::create_directories(temp / "locked");
  open_to_all(temp.path());
  fs::permissions(temp / "locked", fs::perms::owner_read | fs::perms::owner_exec, fs::perm_options::replace);
  fs::permissions(temp / "locked", fs::perms::others_read | fs::perms::others_exec, fs::perm_options::add);
  for (const char* command : {"analyze", "diagnose", "check"}) {
    INFO(command);
    const tests::ProcessResult result = tests::run(
        {tests::kBinary, command, (temp / "made").string(), "-q", "--out", (temp / "locked/out").string()}, "/", user);
    INFO(result.err);
    CHECK(result.status == 3);
    CHECK(says(result, "locked"));
    CHECK(names_in(temp / "locked").empty());
  }
  fs::permissions(temp / "locked", fs::perms::owner_all);
}

TEST_CASE("files that may not be read are wrong input that names them, and leave nothing behind") {
  const tests::User user = held_back_by_permissions();
  if (!can_run(user)) {
    WARN("skipped: nobody may not run the program where it lies");
    return;
  }
  for (const char* closed : {"made/experiment.toml", "made/tracks/up.csv"}) {
    INFO(closed);
    const tests::TempDir temp;
    tests::write_track_experiment(temp / "made");
    fs::create_directories(temp / "place");
    open_to_all(temp.path());
    fs::permissions(temp / "place", fs::perms::all);
    fs::permissions(temp / closed, fs::perms::none);
    const tests::ProcessResult result = tests::run(
        {tests::kBinary, "analyze", (temp / "made").string(), "-q", "--out", (temp / "place/out").string()}, "/", user);
    INFO(result.err);
    CHECK(result.status == 1);
    CHECK(says(result, fs::path(closed).filename().string()));
    CHECK(names_in(temp / "place").empty());
  }
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

TEST_CASE("blind touches no cases that it did not make") {
  const tests::TempDir temp;
  fs::create_directories(temp / "out/cases/0000");
  base::write_file(temp / "out/cases/0000/own.txt", "mine");
  const tests::ProcessResult result = tests::glidelab({"blind", "--cases", "1", "-q", "-o", temp / "out"});
  INFO(result.err);
  CHECK(result.status == 1);
  CHECK(says(result, "a folder that no run of blind made"));
  CHECK(base::read_file(temp / "out/cases/0000/own.txt") == "mine");
}

TEST_CASE("a file that an option names is replaced only where that option wrote it") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  tests::write_tiny_scenario(temp / "own.toml");
  const std::string own = base::read_file(temp / "own.toml");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"diagnose", "made", "-q", "--twin", "own.toml"},
        {"validate", "own.toml", "-q", "--runs", "10", "--write-baseline", "own.toml"}}) {
    const tests::ProcessResult result = tests::glidelab(command, temp.path());
    INFO(result.err);
    CHECK(result.status == 1);
    CHECK(says(result, "a file that this option did not write"));
    CHECK(base::read_file(temp / "own.toml") == own);
  }
}

TEST_CASE("a twin's place that cannot be written is said before the diagnosis") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult result =
      tests::glidelab({"diagnose", "made", "-q", "--no-page", "--twin", "nowhere/twin.toml"}, temp.path());
  INFO(result.err);
  CHECK(result.status == 3);
  CHECK(says(result, "twin.toml: cannot be written"));
  CHECK_FALSE(fs::exists(temp / "glidelab-out"));
}
