/// Where there is no room for what a command writes: one clear message, and nothing half-written.
#include <fmt/format.h>
#include <sys/mount.h>

#include <filesystem>
#include <string>
#include <vector>

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

/// A file system in memory of this size, for as long as this lives; not there where it may not be mounted.
class SmallDisk {
 public:
  SmallDisk(fs::path place, const char* size) : place_(std::move(place)) {
    fs::create_directories(place_);
    there_ = ::mount("tmpfs", place_.c_str(), "tmpfs", 0, fmt::format("size={}", size).c_str()) == 0;
  }
  ~SmallDisk() {
    if (there_) ::umount2(place_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool there() const { return there_; }

 private:
  fs::path place_;
  bool there_ = false;
};

}  // namespace

TEST_CASE("on a full disk a command ends with an error of the environment and takes back what it wrote") {
  const tests::TempDir temp;
  const SmallDisk disk(temp / "disk", "64k");
  if (!disk.there()) {
    WARN("skipped: no file system may be mounted");
    return;
  }
  tests::write_track_experiment(temp / "made");
  tests::write_tiny_scenario(temp / "tiny.toml");
  struct Run {
    const char* command;
    const char* input;
    std::size_t own_kib;  ///< of the disk's 64 that something of a person's takes: what is left is filled on the way
  };
  for (const auto& [command, input, own_kib] :
       {Run{"analyze", "made", 60}, Run{"diagnose", "made", 60}, Run{"check", "made", 60},
        Run{"render", "tiny.toml", 60}, Run{"simulate", "tiny.toml", 64}}) {
    INFO(command);
    base::write_file(temp / "disk/own", std::string(own_kib * 1024, 'x'));
    const tests::ProcessResult result =
        tests::glidelab({command, (temp / input).string(), "-q", "--out", (temp / "disk/out").string()});
    INFO(result.err);
    CHECK(result.status == 3);
    CHECK(says(result, "No space left"));
    CHECK(names_in(temp / "disk") == std::vector<std::string>{"own"});
    CHECK(fs::file_size(temp / "disk/own") == own_kib * 1024);
  }
}

TEST_CASE("a result that the standard output has no room for is an error of the environment") {
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
  // 8 blocks of 512 bytes: the first image does not fit. SIGXFSZ is ignored, as under a quota write(2) then fails.
  const tests::ProcessResult result =
      tests::run({"sh", "-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" render \"$1\" -q --out \"$2\"", tests::kBinary,
                  (temp / "tiny.toml").string(), (temp / "out").string()});
  INFO(result.err);
  CHECK(result.status == 3);
  CHECK(names_in(temp.path()) == std::vector<std::string>{"tiny.toml"});
}

TEST_CASE("help, version, manual page and completion on a full standard output are errors of the environment") {
  if (!fs::exists("/dev/full")) {
    WARN("skipped: no /dev/full");
    return;
  }
  for (const char* wanted :
       {"--man", "--help", "--version", "--completion bash", "--completion zsh", "render --help", "help render"}) {
    const tests::ProcessResult result =
        tests::run({"sh", "-c", std::string("\"$0\" ") + wanted + " > /dev/full", tests::kBinary});
    INFO(wanted << ": " << result.err);
    CHECK(result.status == 3);
    CHECK(says(result, "standard output: cannot be written: No space left"));
  }
}

TEST_CASE("a command whose output nobody reads ends like other programs there, with its results in place") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const auto run = [&](const std::string& command) {
    fs::remove_all(temp / "out");
    return tests::run({"sh", "-c", command, tests::kBinary, (temp / "made").string(), (temp / "out").string(),
                       (temp / "text").string(), (temp / "status").string()});
  };
  const auto status = [&] { return base::read_file(temp / "status"); };
  constexpr const char* kBySigpipe = "141\n";  // 128 + 13, as a shell reports it
  run("{ \"$0\" analyze \"$1\" --out \"$2\"; echo $? > \"$4\"; } 2>&1 | true");
  CHECK(status() == kBySigpipe);
  CHECK(fs::exists(temp / "out/results.json"));

  run("{ \"$0\" analyze \"$1\" --out \"$2\" 2>&1 > \"$3\"; echo $? > \"$4\"; } | true");  // only the progress is lost
  CHECK(status() == "0\n");
  CHECK(base::read_file(temp / "text").starts_with("K/m = "));

  // A closed stream, whose number a file would take.
  for (const char* closed : {"2>&-", "2>&- <&-"}) {
    CAPTURE(closed);
    const tests::ProcessResult result = run(std::string("\"$0\" analyze \"$1\" --out \"$2\" --verbose ") + closed);
    CHECK(result.status == 0);
    CHECK(result.out.starts_with("K/m = "));
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(temp / "out")) {
      if (!file.is_regular_file()) continue;
      CAPTURE(file.path());
      CHECK(base::read_file(file.path()).find("of processor time") == std::string::npos);
    }
  }
  CHECK(run("\"$0\" analyze \"$1\" --out \"$2\" >&-").status == 3);
}
