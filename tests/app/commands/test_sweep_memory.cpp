/// What a sweep keeps in memory, as the system counts it.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"

using namespace glidelab;

namespace {

/// Peak resident memory of the program with these arguments, in MB; -1 where it fails.
double peak_mb(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), tests::kBinary);
  std::vector<char*> words;
  for (std::string& word : arguments) words.push_back(word.data());
  words.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execv(words.front(), words.data());
    ::_exit(127);
  }
  int status = 0;
  rusage used{};
  if (child < 0 || ::wait4(child, &status, 0, &used) != child || status != 0) return -1.0;
  return static_cast<double>(used.ru_maxrss) * 1024.0 / 1e6;
}

}  // namespace

TEST_CASE("A sweep of ten times as many runs takes no more memory, and nor does its merge", "[slow]") {
  const tests::TempDir dir;
  const auto sweep_of = [&](const char* name, int replicates) {
    std::filesystem::create_directory(dir / name);
    return tests::write_sweep(dir / name, fmt::format("replicates = {}\nestimators = [\"phase-diagram\"]", replicates),
                              tests::kTwoKeys)
        .string();
  };
  // Kept, a run would take 1.3 kB: four quantities of some 240 bytes, a clip of 170 and its own 150. 18,000 more make
  // 23 MB. What varies otherwise is the allocator's, and SQLite's pages and sorters of 2 MB each.
  constexpr double kMost_mb = 8.0;
  const std::string few = sweep_of("few", 334), many = sweep_of("many", 3334);  // 2004 and 20004 runs of six points
  const double of_few = peak_mb({"sweep", few, "-q", "--jobs", "2", "-o", dir / "few-out"});
  const double of_many = peak_mb({"sweep", many, "-q", "--jobs", "2", "-o", dir / "many-out"});
  INFO(of_few << " MB, " << of_many << " MB");
  REQUIRE(of_few > 0.0);
  REQUIRE(of_many > 0.0);
  CHECK(of_many < of_few + kMost_mb);
  const auto merge = [&](const std::string& sweep, const char* out) {
    return peak_mb({"sweep", sweep, "-q", "-o", dir / out / "merged", "--merge", dir / out / "sweep.sqlite"});
  };
  const double merge_few = merge(few, "few-out"), merge_many = merge(many, "many-out");
  INFO(merge_few << " MB, " << merge_many << " MB merged");
  REQUIRE(merge_few > 0.0);
  CHECK(merge_many < merge_few + kMost_mb);
}
