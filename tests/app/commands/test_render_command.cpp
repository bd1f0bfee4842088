/// `glidelab render`: two folders that appear together, or not at all.
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "test_paths.h"
#include "tests/app/run_process.h"
#include "tests/app/tiny_scenario.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::size_t entries(const fs::path& dir) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(dir), fs::directory_iterator{}));
}

tests::ProcessResult render_tiny(const tests::TempDir& temp, std::vector<std::string> more = {}) {
  tests::write_tiny_scenario(temp / "tiny.toml");
  std::vector<std::string> arguments = {"render", "tiny.toml", "--out", "out"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return tests::glidelab(arguments, temp.path());
}

}  // namespace

TEST_CASE("render writes an experiment that core reads, and the truth beside it") {
  const tests::TempDir temp;
  const tests::ProcessResult result = render_tiny(temp, {"--json", "--seed", "11"});
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json document = json::parse(result.out);
  CHECK(document.at("format") == 1);
  CHECK(document.at("clips") == 1);
  CHECK(document.at("frames") == 30);
  CHECK(document.at("seed") == 11);
  CHECK(fs::equivalent(document.at("experiment").get<std::string>(), temp / "out"));
  CHECK(fs::equivalent(document.at("truth").get<std::string>(), temp / "out.truth"));
  CHECK(core::read_experiment(temp / "out").clips.size() == 1);
  CHECK(json::parse(base::read_file(temp / "out.truth/truth.json")).at("seed") == 11);
  CHECK(entries(temp.path()) == 3);  // tiny.toml, out, out.truth
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(temp / "out")) {
    CHECK(entry.path().filename().string().find("truth") == std::string::npos);
    CHECK(entry.path().filename().string().find("trajectory") == std::string::npos);
  }
}

TEST_CASE("the same seed gives the same files for any number of jobs, another seed others") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml");
  for (const std::vector<std::string>& run :
       {std::vector<std::string>{"a", "1", "5"}, {"b", "2", "5"}, {"c", "2", "6"}}) {
    REQUIRE(
        tests::glidelab({"render", "tiny.toml", "-q", "--out", run[0], "--jobs", run[1], "--seed", run[2]}, temp.path())
            .status == 0);
  }
  CHECK(base::read_file(temp / "a/clips/up.mkv") == base::read_file(temp / "b/clips/up.mkv"));
  CHECK(base::read_file(temp / "a/clips/up.mkv") != base::read_file(temp / "c/clips/up.mkv"));
  CHECK(base::read_file(temp / "a.truth/trajectory-up.csv") == base::read_file(temp / "c.truth/trajectory-up.csv"));
}

TEST_CASE("render replaces what render made, as a whole") {
  const tests::TempDir temp;
  REQUIRE(render_tiny(temp).status == 0);
  base::write_file(temp / "out/clips/stale.mkv", "stale");
  base::list_made_files(temp / "out");  // as if an earlier scenario had had such a clip
  REQUIRE(render_tiny(temp).status == 0);
  CHECK_FALSE(fs::exists(temp / "out/clips/stale.mkv"));
}

TEST_CASE("render refuses its own folder once it holds anything of somebody's, and touches nothing") {
  const tests::TempDir temp;
  REQUIRE(render_tiny(temp, {"--seed", "1"}).status == 0);
  const auto refused = [&](const std::string& name, const std::string& words) {
    const std::string clip = base::read_file(temp / "out/clips/up.mkv");
    const std::string before = base::read_file(temp / name);
    const tests::ProcessResult result = render_tiny(temp, {"--seed", "2"});
    INFO(name << ": " << result.err);
    CHECK(result.status == 1);
    CHECK(result.err.find(words) != std::string::npos);
    CHECK(base::read_file(temp / name) == before);
    CHECK(base::read_file(temp / "out/clips/up.mkv") == clip);
    CHECK(entries(temp.path()) == 3);
  };
  base::write_file(temp / "out/notes.txt", "mine");
  refused("out/notes.txt", "notes.txt");
  fs::remove(temp / "out/notes.txt");
  base::write_file(temp / "out/clips/own-recording.mkv", "mine");
  refused("out/clips/own-recording.mkv", "clips/own-recording.mkv");
  fs::remove(temp / "out/clips/own-recording.mkv");
  base::write_file(temp / "out.truth/notes.txt", "mine");
  refused("out.truth/notes.txt", "notes.txt");
  fs::remove(temp / "out.truth/notes.txt");
  CHECK(render_tiny(temp, {"--seed", "2"}).status == 0);
  const std::string made = base::read_file(temp / "out/experiment.toml");
  base::write_file(temp / "out/experiment.toml", made + "# my remark\n");
  refused("out/experiment.toml", "experiment.toml (changed)");
  base::write_file(temp / "out/experiment.toml", made);
  fs::remove(temp / "out/plumb.png");  // what is gone cannot be lost
  CHECK(render_tiny(temp, {"--seed", "2"}).status == 0);
}

TEST_CASE("render refuses a folder with files that it did not make, and touches none of them") {
  const tests::TempDir temp;
  fs::create_directories(temp / "out");
  base::write_file(temp / "out/thesis.txt", "mine");
  tests::ProcessResult result = render_tiny(temp);
  CHECK(result.status == 1);
  CHECK(result.err.find((temp / "out").string()) != std::string::npos);
  CHECK(base::read_file(temp / "out/thesis.txt") == "mine");
  CHECK(entries(temp.path()) == 2);
  fs::remove_all(temp / "out");
  fs::create_directories(temp / "out.truth");
  base::write_file(temp / "out.truth/thesis.txt", "mine");
  result = render_tiny(temp);
  CHECK(result.status == 1);
  CHECK(base::read_file(temp / "out.truth/thesis.txt") == "mine");
}

TEST_CASE("an empty folder is taken") {
  const tests::TempDir temp;
  fs::create_directories(temp / "out");
  CHECK(render_tiny(temp).status == 0);
  CHECK(fs::exists(temp / "out/experiment.toml"));
}

TEST_CASE("wrong keys of a scenario are status 1, one line each with file, line and key, and nothing is written") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml", 0.3, "mass = 3\ngravity_m_s2 = \"heavy\"");
  const tests::ProcessResult result = tests::glidelab({"render", "tiny.toml", "--out", "out"}, temp.path());
  CHECK(result.status == 1);
  CHECK(result.err.find("tiny.toml:4: mass: found an unknown key") != std::string::npos);
  CHECK(result.err.find("tiny.toml:5: gravity_m_s2: found text \"heavy\"") != std::string::npos);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 2);
  CHECK(entries(temp.path()) == 1);
}

TEST_CASE("a disk that fills up while rendering is status 3, with nothing left behind") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml");
  // The clip takes some 300 kB; files end at 200 blocks of 512 bytes.
  const tests::ProcessResult result =
      tests::run({"sh", "-c", "ulimit -f 200 && exec \"$0\" render tiny.toml --out out", tests::kBinary}, temp.path());
  INFO(result.err);
  CHECK(result.status == 3);
  CHECK(entries(temp.path()) == 1);
}

TEST_CASE("an output below a file is status 3, found before the work") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml");
  const tests::ProcessResult result = tests::glidelab({"render", "tiny.toml", "--out", "tiny.toml/out"}, temp.path());
  CHECK(result.status == 3);
  CHECK(result.err.find("rendering") == std::string::npos);
}

TEST_CASE("an interrupt ends rendering with status 130 and leaves nothing behind") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const std::string out = GENERATE("out", "runs/today/out");  // nor the folders above it that it made
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml", 60.0);  // 6000 frames: far longer than this test waits
  tests::Process process({tests::kBinary, "render", "tiny.toml", "--out", out}, temp.path());
  // A staging folder beside the scenario says that the work has begun.
  for (int tries = 0; tries < 500 && entries(temp.path()) == 1; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  REQUIRE(entries(temp.path()) > 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  REQUIRE(process.running());
  process.send(signal);
  const tests::ProcessResult result = process.wait();
  CHECK(result.status == 130);
  CHECK(result.err.find("interrupted") != std::string::npos);
  CHECK(entries(temp.path()) == 1);
}
