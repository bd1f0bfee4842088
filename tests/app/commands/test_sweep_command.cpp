/// glidelab sweep as a user of the shell sees it: killed and continued, in shards, wrong.
#include <fmt/format.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/study/sweep/sqlite.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

/// All that a sweep stores, but the times that runs took.
std::string contents(const fs::path& file) {
  validate::Database database(file, validate::Database::Mode::read);
  std::string text;
  for (const char* select : {"SELECT * FROM run ORDER BY run", "SELECT * FROM result ORDER BY 1, 2, 3, 4",
                             "SELECT * FROM clip ORDER BY 1, 2, 3", "SELECT * FROM \"schema\" ORDER BY 1, 2"}) {
    validate::SqlStatement rows = database.prepare(select);
    while (rows.step()) {
      for (int column = 0; column < 4; ++column) text += rows.text(column) + "|";
      for (int column = 4; column < 10; ++column) text += fmt::format("{:a}|", rows.number(column));
      text += "\n";
    }
  }
  return text;
}

std::int64_t runs_in(const fs::path& file) {
  if (!fs::exists(file)) return 0;
  validate::Database database(file, validate::Database::Mode::read);
  validate::SqlStatement table = database.prepare("SELECT count(*) FROM sqlite_master WHERE name = 'run'");
  table.step();
  if (table.integer(0) == 0) return 0;
  validate::SqlStatement rows = database.prepare("SELECT count(*) FROM run");
  rows.step();
  return rows.integer(0);
}

}  // namespace

TEST_CASE("A sweep that is killed at random instants and continued ends as one that was not", "[slow]") {
  const tests::TempDir dir;
  const std::string sweep =
      tests::write_sweep(dir.path(), "replicates = 600\nestimators = [\"phase-diagram\"]", tests::kTwoKeys);
  const tests::ProcessResult whole = tests::glidelab({"sweep", sweep, "-q", "-o", dir / "whole"});
  REQUIRE(whole.status == 0);
  std::mt19937 random(3);
  std::int64_t before = 0;
  int kills = 0, in_the_middle = 0;
  const fs::path database = dir / "killed" / "sweep.sqlite";
  while (kills < 50) {
    tests::Process process({tests::kBinary, "sweep", sweep, "-q", "-o", dir / "killed", "--jobs", "2"});
    // Every other one is killed at a random instant of its start, the others at one after a run was finished; on a busy
    // machine the start alone may take a second.
    std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<int>(10, 200)(random)));
    if (kills % 2 == 1) {
      while (process.running() && runs_in(database) == before) {
        std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<int>(1, 20)(random)));
      }
    }
    if (!process.running()) break;
    process.send(SIGKILL);
    process.wait();
    ++kills;
    const std::int64_t now = runs_in(database);
    CHECK(now >= before);  // nothing that was finished is lost
    if (now > before && now < 3600) ++in_the_middle;
    before = now;
  }
  CHECK(kills == 50);  // else the sweep was at its end before: too few runs for this machine
  CHECK(in_the_middle >= 3);
  const tests::ProcessResult rest = tests::glidelab({"sweep", sweep, "-q", "-o", dir / "killed"});
  CHECK(rest.status == 0);
  CHECK(runs_in(database) == 3600);
  CHECK(contents(database) == contents(dir / "whole" / "sweep.sqlite"));
  CHECK(rest.out == whole.out);
}

TEST_CASE("Shards merged are the sweep as a whole, and a page says what came out") {
  const tests::TempDir dir;
  const std::string sweep = tests::write_sweep(dir.path(), "", tests::kTwoKeys);
  const fs::path out = dir / "out";
  REQUIRE(tests::glidelab({"sweep", sweep, "-o", out / "whole"}).status == 0);
  for (const char* shard : {"1/2", "2/2"}) {
    REQUIRE(tests::glidelab({"sweep", sweep, "-q", "-o", out / "parts", "--shard", shard}).status == 0);
  }
  const tests::ProcessResult merged =
      tests::glidelab({"sweep", sweep, "-o", out / "merged", "--merge", out / "parts" / "sweep-1-of-2.sqlite",
                       out / "parts" / "sweep-2-of-2.sqlite"});
  CHECK(merged.status == 0);
  CHECK(contents(out / "merged" / "sweep.sqlite") == contents(out / "whole" / "sweep.sqlite"));
  const std::string page = base::read_file(out / "merged" / "report.html");
  CHECK(page.find("<svg") == std::string::npos);  // as images of their own
  CHECK(page.find("data:image/svg+xml") != std::string::npos);
  CHECK(page.find("6 / 6") != std::string::npos);
}

TEST_CASE("What a sweep refuses is one clear message with the right status") {
  const tests::TempDir dir;
  const std::string sweep = tests::write_sweep(dir.path(), "", tests::kTwoKeys);
  const fs::path out = dir / "out";
  SECTION("1e9 runs without being told to") {
    const std::string many = tests::write_sweep(dir.path(), "replicates = 200000000", tests::kTwoKeys);
    const tests::ProcessResult result = tests::glidelab({"sweep", many, "-o", out});
    CHECK(result.status == 1);
    CHECK(result.err.find("1200000000 runs") != std::string::npos);
    CHECK(result.err.find("--many-runs") != std::string::npos);
    CHECK(result.err.find("of disk") != std::string::npos);
    CHECK(result.err.find(" threads") != std::string::npos);
    CHECK_FALSE(fs::exists(out / "sweep.sqlite"));
  }
  SECTION("a database of another sweep") {
    REQUIRE(tests::glidelab({"sweep", sweep, "-q", "-o", out}).status == 0);
    tests::write_sweep(dir.path(), "seed = 9", tests::kTwoKeys);
    const tests::ProcessResult result = tests::glidelab({"sweep", sweep, "-o", out});
    CHECK(result.status == 1);
    CHECK(result.err.find("sweep.sqlite") != std::string::npos);
  }
  SECTION("a part that there is not, or no number of parts") {
    for (const char* part : {"3/2", "0/2", "-1/2", "1/-1", "+1/2", " 1/2", "1/2 ", "1/2/3", "1",
                             "1/99999999999999999999", "99999999999999999999/99999999999999999999", "1/1000000001"}) {
      const tests::ProcessResult result = tests::glidelab({"sweep", sweep, "-o", out, "--shard", part});
      INFO(part << ": " << result.err);
      CHECK(result.status == 2);
      CHECK(result.err.find(fmt::format("--shard: \"{}\" is not a part such as 2/8", part)) != std::string::npos);
    }
    CHECK_FALSE(fs::exists(out));
  }
  SECTION("a run of no such number") {
    for (const char* run : {"-1", "1.5", "x", "99999999999999999999"}) {
      const tests::ProcessResult result = tests::glidelab({"sweep", sweep, "--show", run});
      INFO(result.err);
      CHECK(result.status == 2);
      CHECK(result.err.find(fmt::format("--show: \"{}\" is not a whole number", run)) != std::string::npos);
    }
    CHECK(tests::glidelab({"sweep", sweep, "--show", "6"}).err.find("one of the runs 0 to 5") != std::string::npos);
  }
  SECTION("two options that do other things") {
    for (const std::vector<std::string>& other : {std::vector<std::string>{"--merge", "a.sqlite"}, {"--show", "1"}}) {
      std::vector<std::string> arguments = {"sweep", sweep, "-o", out, "--dry-run"};
      arguments.insert(arguments.end(), other.begin(), other.end());
      const tests::ProcessResult result = tests::glidelab(arguments);
      CHECK(result.status == 2);
      CHECK(result.err.find("excludes") != std::string::npos);
    }
  }
  SECTION("a place where nothing can be written, before it says how long it would take") {
    const tests::ProcessResult result =
        tests::glidelab({"sweep", sweep, "-o", dir / "sweep.toml" / "out", "--dry-run"});
    INFO(result.err);
    CHECK(result.status == 3);
    CHECK(result.err.find("sweep.toml/out: cannot be written") != std::string::npos);
    CHECK(result.err.find(" runs") == std::string::npos);
  }
  SECTION("two processes on one database") {
    const std::string long_one = tests::write_sweep(dir.path(), "replicates = 10000", tests::kTwoKeys);
    tests::Process first({tests::kBinary, "sweep", long_one, "-q", "-o", out});
    for (int i = 0; i < 600 && runs_in(out / "sweep.sqlite") == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    const tests::ProcessResult second = tests::glidelab({"sweep", long_one, "-o", out});
    CHECK(second.status == 3);
    CHECK(second.err.find("another process") != std::string::npos);
    first.send(SIGINT);
    CHECK(first.wait().status == 130);
  }
}

TEST_CASE("A merge takes all of its files or none, and says what is not there yet, and a shard writes no page") {
  const tests::TempDir dir;
  const std::string sweep = tests::write_sweep(dir.path(), "", tests::kTwoKeys);
  const fs::path out = dir / "out";
  REQUIRE(tests::glidelab({"sweep", sweep, "-q", "-o", out, "--shard", "1/2"}).status == 0);
  CHECK_FALSE(fs::exists(out / "report.html"));
  const std::string part = out / "sweep-1-of-2.sqlite";
  const tests::ProcessResult wrong = tests::glidelab({"sweep", sweep, "-o", out, "--merge", part, dir / "none.sqlite"});
  CHECK(wrong.status == 1);
  CHECK(wrong.err.find("none.sqlite") != std::string::npos);
  CHECK_FALSE(fs::exists(out / "sweep.sqlite"));
  const tests::ProcessResult half = tests::glidelab({"sweep", sweep, "-o", out, "--merge", part});
  CHECK(half.status == 0);
  CHECK(half.err.find("incomplete: 3 of 6 runs are missing") != std::string::npos);
  // A merge that came too early is no hindrance to that of all.
  REQUIRE(tests::glidelab({"sweep", sweep, "-q", "-o", out, "--shard", "2/2"}).status == 0);
  const tests::ProcessResult all =
      tests::glidelab({"sweep", sweep, "-o", out, "--merge", part, out / "sweep-2-of-2.sqlite"});
  INFO(all.err);
  CHECK(all.status == 0);
  CHECK(runs_in(out / "sweep.sqlite") == 6);
}

TEST_CASE("A part of a sweep that was cut off is wrong input, named, and nothing is merged") {
  const tests::TempDir dir;
  const std::string sweep = tests::write_sweep(dir.path(), "", tests::kTwoKeys);
  const fs::path out = dir / "out", part = out / "sweep-1-of-2.sqlite";
  REQUIRE(tests::glidelab({"sweep", sweep, "-q", "-o", out, "--shard", "1/2"}).status == 0);
  const std::uintmax_t size = fs::file_size(part);
  REQUIRE(size > 20000);
  for (const std::uintmax_t left : {std::uintmax_t{1000}, std::uintmax_t{4096}, std::uintmax_t{20000}, size - 4096}) {
    fs::copy_file(part, dir / "cut.sqlite", fs::copy_options::overwrite_existing);
    fs::resize_file(dir / "cut.sqlite", left);
    const tests::ProcessResult result = tests::glidelab({"sweep", sweep, "-o", out, "--merge", dir / "cut.sqlite"});
    INFO(left << " bytes: " << result.err);
    CHECK(result.status == 1);
    CHECK(result.err.find("cut.sqlite") != std::string::npos);
    CHECK_FALSE(fs::exists(out / "sweep.sqlite"));
  }
}

TEST_CASE("A job array's script takes the number of parts from a whole array only, else it wants to be told") {
  const tests::TempDir dir;
  const std::string script = fs::path(tests::kSourceDir) / "tools/sweep.sbatch";
  struct Task {
    int id, min, max, count;
    std::string parts, in_environment;
  };
  const auto task = [&](const Task& of) {
    std::vector<std::string> arguments = {"env",
                                          "GLIDELAB=echo",
                                          fmt::format("SLURM_ARRAY_TASK_ID={}", of.id),
                                          fmt::format("SLURM_ARRAY_TASK_MIN={}", of.min),
                                          fmt::format("SLURM_ARRAY_TASK_MAX={}", of.max),
                                          fmt::format("SLURM_ARRAY_TASK_COUNT={}", of.count),
                                          "SLURM_CPUS_PER_TASK=1",
                                          "GLIDELAB_PARTS=" + of.in_environment,
                                          "sh",
                                          script,
                                          "s.toml",
                                          "out"};
    if (!of.parts.empty()) arguments.push_back(of.parts);
    return tests::run(arguments, dir.path());
  };
  const auto does = [&](const Task& of, const std::string& shard) {
    const tests::ProcessResult result = task(of);
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(result.out == "sweep s.toml -o out --quiet --shard " + shard + " --jobs 1\n");
  };
  const auto refuses = [&](const Task& of) {
    const tests::ProcessResult result = task(of);
    INFO(result.out << result.err);
    CHECK(result.status == 2);
    CHECK(result.out.empty());
    CHECK(result.err.starts_with("sweep.sbatch: "));
  };
  does({1, 1, 8, 8, "", ""}, "1/8");
  does({8, 1, 8, 8, "", ""}, "8/8");
  does({1, 1, 1, 1, "8", ""}, "1/8");
  does({5, 5, 5, 1, "", "8"}, "5/8");
  refuses({1, 1, 1, 1, "", ""});   // one task: again, or of one part?
  refuses({5, 1, 5, 2, "", ""});   // 1,5
  refuses({7, 0, 7, 8, "", ""});   // from 0
  refuses({9, 9, 9, 1, "8", ""});  // no part
  refuses({0, 0, 7, 8, "8", ""});
  refuses({1, 1, 1, 1, "x", ""});
  fs::create_directory(dir / "out");
  base::write_file(dir / "out/sweep-3-of-8.sqlite", "");
  refuses({1, 1, 2, 2, "", ""});  // 1 and 2 of 8 again
  does({1, 1, 2, 2, "8", ""}, "1/8");
  does({1, 1, 8, 8, "", ""}, "1/8");
}

TEST_CASE("The size is said before a sweep starts, and a run's whole scenario can be had") {
  const tests::TempDir dir;
  const std::string sweep = tests::write_sweep(dir.path(), "replicates = 3", tests::kTwoKeys);
  const tests::ProcessResult dry = tests::glidelab({"sweep", sweep, "-o", dir / "out", "--dry-run"});
  CHECK(dry.status == 0);
  CHECK(dry.err.find("18 runs, 18 still to do") != std::string::npos);
  const tests::ProcessResult as_json = tests::glidelab({"sweep", sweep, "-o", dir / "out", "--dry-run", "--json"});
  CHECK(as_json.status == 0);
  CHECK(nlohmann::json::parse(as_json.out).at("missing_runs") == 18);
  CHECK_FALSE(fs::exists(dir / "out"));
  const tests::ProcessResult shown = tests::glidelab({"sweep", sweep, "--show", "17"});
  CHECK(shown.status == 0);
  base::write_file(dir / "run17.toml", shown.out);
  CHECK(shown.out.find("frame_rate_hz = 80") != std::string::npos);
  CHECK(tests::glidelab({"simulate", dir / "run17.toml", "-o", dir / "simulated"}).status == 0);
}

TEST_CASE("An interrupted sweep says how many runs are kept, and the next one has as many less to do") {
  const tests::TempDir dir;
  const std::string sweep = tests::write_sweep(dir.path(), "replicates = 2000", tests::kTwoKeys);
  tests::Process process({tests::kBinary, "sweep", sweep, "-q", "-o", dir / "out"});
  for (int tries = 0; tries < 500 && runs_in(dir / "out/sweep.sqlite") == 0; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  process.send(SIGINT);
  const tests::ProcessResult result = process.wait();
  INFO(result.err);
  CHECK(result.status == 130);
  const std::int64_t kept = runs_in(dir / "out/sweep.sqlite");
  CHECK(kept > 0);
  CHECK(kept < 12000);
  CHECK(result.err.find(fmt::format("interrupted; {} of 12000 runs are kept in ", kept)) != std::string::npos);
}

TEST_CASE("A scenario in place of a sweep, and a sweep in place of a scenario, are called what they are") {
  const tests::TempDir dir;
  const std::string sweep = tests::write_sweep(dir.path(), "replicates = 3", tests::kTwoKeys);
  for (const char* command : {"simulate", "render", "validate"}) {
    const tests::ProcessResult result = tests::glidelab({command, sweep, "-o", dir / "out"});
    CHECK(result.status == 1);
    CHECK(result.err == fmt::format("glidelab: error: {}: found a sweep, expected a scenario; sweep and require take a "
                                    "sweep\n",
                                    sweep));
  }
  const tests::ProcessResult result = tests::glidelab({"sweep", dir / "scenario.toml", "-o", dir / "out"});
  CHECK(result.status == 1);
  CHECK(result.err.find("scenario.toml: found a scenario, expected a sweep") != std::string::npos);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
}
