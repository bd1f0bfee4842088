/// Another program, run to its end or stopped.
#include "base/files/child_process.h"

#include <chrono>
#include <csignal>

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
