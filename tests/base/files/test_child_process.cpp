/// Another program, run to its end or stopped.
#include "base/files/child_process.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

TEST_CASE("a program that runs on is ended when it is asked to stop, even where it ignores the request") {
  const tests::TempDir temp;
  const auto start = std::chrono::steady_clock::now();
  for (const char* script : {"exec sleep 60", "trap \"\" TERM; sleep 60; sleep 60"}) {
    const int status = base::run_program("sh", {"-c", script}, temp / "log", {}, {}, [] { return true; });
    CHECK_FALSE(base::how_it_failed(status).empty());
  }
  // 0.5 s of patience for the second one; the rest is for a busy machine.
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  CHECK(base::how_it_failed(base::run_program("true", {}, temp / "log", {}, {}, [] { return false; })).empty());
}

TEST_CASE("a program that takes longer than it may is ended, with what it started, and is told from one that fails") {
  const tests::TempDir temp;
  const base::ProgramLimits short_time{.wall_s = 0.2};
  // The sleeper in the background would write the file after a second.
  const base::ProgramEnd late = base::run_limited(
      "sh", {"-c", "(sleep 1; touch " + (temp / "later").string() + ") & sleep 60"}, temp / "log", short_time);
  CHECK(late.by == base::ProgramEndedBy::time);
  CHECK(late.wall_s >= 0.2);
  CHECK(late.wall_s < 20.0);  // for a busy machine
  const base::ProgramEnd left =
      base::run_limited("sh", {"-c", "(sleep 1; touch " + (temp / "left").string() + ") &"}, temp / "log", {});
  CHECK(left.by == base::ProgramEndedBy::itself);
  CHECK(base::how_it_failed(left.status).empty());
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  CHECK_FALSE(std::filesystem::exists(temp / "later"));
  CHECK_FALSE(std::filesystem::exists(temp / "left"));
  const base::ProgramEnd failed = base::run_limited("sh", {"-c", "exit 7"}, temp / "log", {});
  CHECK(failed.by == base::ProgramEndedBy::itself);
  CHECK(base::how_it_failed(failed.status) == "failed with status 7");
  CHECK(base::run_limited("sleep", {"60"}, temp / "log", {}, [] { return true; }).by == base::ProgramEndedBy::request);
}

TEST_CASE("a program gets no more memory, and writes no larger file, than it may") {
  const tests::TempDir temp;
  // dd asks for one block of 256 MiB at once.
  const std::vector<std::string> block = {"if=/dev/zero", "of=/dev/null", "bs=256M", "count=1"};
  CHECK_FALSE(base::how_it_failed(base::run_limited("dd", block, temp / "log", {60.0, 128u << 20}).status).empty());
  CHECK(base::how_it_failed(base::run_limited("dd", block, temp / "log", {60.0, 1024u << 20}).status).empty());
  const std::vector<std::string> file = {"if=/dev/zero", "of=" + (temp / "file").string(), "bs=1M", "count=64"};
  CHECK_FALSE(base::how_it_failed(base::run_limited("dd", file, temp / "log", {60.0, 32u << 20}).status).empty());
}

TEST_CASE("where this program has hard limits below those of an outside program, they hold for it too") {
  const tests::TempDir temp;
  // In a process of its own, since nothing raises a hard limit again.
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
#ifdef __SANITIZE_ADDRESS__
    constexpr bool kOfMemory = false;  // the sanitizer itself takes terabytes of addresses
#else
    constexpr bool kOfMemory = true;
#endif
    const rlimit seconds{50, 50}, bytes{1U << 30, 1U << 30}, file{4096, 4096};
    const bool set = ::setrlimit(RLIMIT_CPU, &seconds) == 0 && (!kOfMemory || ::setrlimit(RLIMIT_AS, &bytes) == 0) &&
                     ::setrlimit(RLIMIT_FSIZE, &file) == 0;
    const std::string memory = kOfMemory ? " && test $(ulimit -H -v) = 1048576" : "";
    const base::ProgramEnd end = base::run_limited(
        "sh", {"-c", "test $(ulimit -H -t) = 50 && test $(ulimit -H -f) = 8" + memory}, temp / "log", {});
    ::_exit(set && base::how_it_failed(end.status).empty() ? 0 : 1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  INFO(base::read_file(temp / "log"));
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("a program is found by its name in PATH or by its path, and only where it can be run") {
  const tests::TempDir temp;
  CHECK(base::is_program("sh"));
  CHECK(base::is_program("/bin/sh"));
  CHECK_FALSE(base::is_program("no-such-program-anywhere"));
  CHECK_FALSE(base::is_program(""));
  CHECK_FALSE(base::is_program(temp.path().string()));  // a folder
  base::write_file(temp / "text", "words");
  CHECK_FALSE(base::is_program((temp / "text").string()));  // nobody may run it
}
