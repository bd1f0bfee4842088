/// Motions that no law follows through `glidelab diagnose`: how long does each take?
///
///     diagnose_nonsense GLIDELAB EXPERIMENTS [FIRST_SEED]
///
/// Each small experiment (tests/diagnose/made_nonsense.h) is diagnosed in a process of its own, on one thread. Allowed:
/// a result, or status 1 with one message; within 60 s of processor time and 512 MiB. What is found is kept in the
/// working directory, and so is the slowest; at the end the ten slowest are listed.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "tests/diagnose/made_nonsense.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

constexpr rlim_t kSeconds = 60;
constexpr long kMostKilobytes = 512 * 1024;

/// Writes the folder; what its motions are.
std::string write_experiment(const fs::path& folder, std::uint64_t seed) {
  std::string toml = "format = 1\nname = \"nonsense\"\n[track]\ndownhill = \"+X\"\n", kinds;
  fs::create_directories(folder);
  for (const tests::NonsenseClip& clip : tests::NonsenseMaker(seed).experiment()) {
    base::CsvWriter table("t_s,x_m");
    for (std::size_t i = 0; i < clip.t_s.size(); ++i) table.number(clip.t_s[i]).number(clip.x_m[i]).end_row();
    base::write_file(folder / (clip.name + ".csv"), table.str());
    toml += fmt::format(
        "[[clip]]\nname = \"{0}\"\ntrack = \"{0}.csv\"\nmass_kg = {1}\nincline_deg = {2}\nincline_sd_deg = {3}\n"
        "launched = \"{0}\"\n",
        clip.name, clip.mass_kg, clip.incline_deg, clip.incline_sd_deg);
    kinds += (kinds.empty() ? "" : ", ") + clip.kind;
  }
  base::write_file(folder / "experiment.toml", toml);
  return kinds;
}

struct Run {
  std::uint64_t seed = 0;
  std::string kinds;
  int status = 0;  ///< 1000 + signal where one ended it
  double seconds = 0.0;
  long kilobytes = 0;
};

Run diagnose(const std::string& program, const fs::path& folder, const fs::path& out, const fs::path& log) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    ::dup2(file, 1);
    ::dup2(file, 2);
    const rlimit seconds{kSeconds, kSeconds + 1}, no_core{0, 0};
    ::setrlimit(RLIMIT_CPU, &seconds);
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::execlp(program.c_str(), program.c_str(), "diagnose", "-q", "--no-page", "--jobs", "1", "-o", out.c_str(),
             folder.c_str(), nullptr);
    ::_exit(127);
  }
  Run run;
  int status = 0;
  rusage usage{};
  ::wait4(pid, &status, 0, &usage);
  run.status = WIFSIGNALED(status) ? 1000 + WTERMSIG(status) : WEXITSTATUS(status);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  run.seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.kilobytes = usage.ru_maxrss;
  return run;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: diagnose_nonsense GLIDELAB EXPERIMENTS [FIRST_SEED]\n");
    return 2;
  }
  const std::uint64_t count = std::strtoull(argv[2], nullptr, 10);
  const std::uint64_t first = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  const base::TemporaryFolder place("nonsense");
  std::vector<Run> runs;
  long found = 0, refused = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const fs::path folder = place / fmt::format("nonsense-{}", seed);
    const std::string kinds = write_experiment(folder, seed);
    Run run = diagnose(argv[1], folder, place / "out", place / "log");
    run.seed = seed;
    run.kinds = kinds;
    refused += run.status == 1;
    if (run.status > 1 || run.kilobytes > kMostKilobytes) {
      ++found;
      fs::copy(folder, fs::current_path() / folder.filename(),
               fs::copy_options::recursive | fs::copy_options::overwrite_existing);
      std::printf("seed %llu (%s): status %d, %.1f s, %ld MiB; kept as %s\n%s\n", static_cast<unsigned long long>(seed),
                  kinds.c_str(), run.status, run.seconds, run.kilobytes / 1024, folder.filename().c_str(),
                  base::read_file(place / "log").substr(0, 1000).c_str());
      std::fflush(stdout);
    }
    runs.push_back(run);
    fs::remove_all(folder);
    fs::remove_all(place / "out");
  }
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.seconds > b.seconds; });
  for (std::size_t i = 0; i < std::min<std::size_t>(10, runs.size()); ++i) {
    std::printf("%.1f s, %ld MiB: seed %llu (%s)\n", runs[i].seconds, runs[i].kilobytes / 1024,
                static_cast<unsigned long long>(runs[i].seed), runs[i].kinds.c_str());
  }
  if (!runs.empty()) write_experiment(fs::current_path() / fmt::format("slowest-{}", runs[0].seed), runs[0].seed);
  std::printf("%zu experiments, %ld refused, %ld findings\n", runs.size(), refused, found);
  return found == 0 ? 0 : 1;
}
