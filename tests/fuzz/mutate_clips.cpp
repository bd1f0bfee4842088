/// Damaged recordings through the analysis: small experiments in five codecs are rendered, and each run damages one of
/// their files (clip, frame, view of the pattern, plane) and analyses the folder in a process of its own. One run in
/// eight has the pattern, whose images take most of an analysis; the others have a scale, and only clips to damage.
///
///     mutate_clips GLIDELAB RUNS [SEED] [--command]
///
/// Works in /dev/shm where that is, unless TMPDIR says otherwise; what is found is kept in the working directory.
/// Allowed: a result, or an InputError or NumericalError; within 30 s of processor time and 512 MiB. With --command the
/// program itself is run (`glidelab analyze`), with what a person sees: exit status 0, or 1 with one message and
/// nothing left under --out or beside it. Else the analysis is called without the report, which is ten times as quick.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "tests/fuzz/damage.h"
#include "tests/one_glider.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

constexpr rlim_t kSeconds = 30;
constexpr long kMostKilobytes = 512 * 1024;
constexpr int kWidthPx = 320, kScaledWidthPx = 240;  // with the pattern, whose corners need them, and with a scale
constexpr std::size_t kCalibrated = 8;               // one run in so many is with the pattern

std::string scenario(const std::string& codec, int width_px) {
  return fmt::format(R"(format = 1
name = "small"
seed = 3
[camera]
width_px = {}
height_px = {}
frame_rate_hz = 100.0
focal_px = [{}.0, {}.0]
position_m = [0.0, 0.1, 2.4]
[calibration]
inner_corners = [7, 5]
square_m = 0.08
views = 4
[marker]
diameter_m = 0.06
[codec]
name = "{}"
{}
)",
                     width_px, width_px * 3 / 4, width_px * 3 / 2, width_px * 3 / 2, codec,
                     codec == "h264" ? "[clock]\nvariable = true" : "") +
         tests::one_glider(4.0, 2.768, 0.0, {{"up", 0.2, -1.2, 0.4}});
}

/// Puts the scale that the scenario's camera has in the place of the calibration and its images.
void take_scale(const fs::path& folder, int width_px) {
  std::string experiment = base::read_file(folder / "experiment.toml");
  const std::size_t from = experiment.find("[calibration]"), to = experiment.find("\n[", from);
  base::write_file(folder / "experiment.toml",
                   experiment.replace(from, to - from, fmt::format("[scale]\npx_per_m = {}\n", width_px * 1.5 / 2.4)));
  fs::remove_all(folder / "calibration");
}

struct Child {
  int status = 0;  ///< exit status, or 1000 + signal
  long kilobytes = 0;
};

/// Runs `body` in a child with the limits; its output goes to `log`.
template <class Body>
Child in_child(const fs::path& log, Body&& body) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    ::dup2(file, 1);
    ::dup2(file, 2);
    const rlimit seconds{kSeconds, kSeconds + 1}, no_core{0, 0};
    ::setrlimit(RLIMIT_CPU, &seconds);
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::_exit(body());
  }
  int status = 0;
  rusage usage{};
  ::wait4(pid, &status, 0, &usage);
  return {WIFSIGNALED(status) ? 1000 + WTERMSIG(status) : WEXITSTATUS(status), usage.ru_maxrss};
}

int run_program(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execvp(argv[0], argv.data());
  return 127;
}

int analyse(const fs::path& folder) {
  try {
    core::analyze({folder}, {.bandwidth_s = {}});
    return 0;
  } catch (const base::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  } catch (const base::NumericalError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }  // anything else ends the child by SIGABRT
}

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() != ".toml") files.push_back(fs::relative(entry, folder));
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// What is wrong with what `glidelab analyze` left behind; empty where nothing is.
std::string wrong_with_command(const Child& child, const fs::path& scratch) {
  const std::string said = base::read_file(scratch / "log");
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(scratch)) ++entries;  // log, damaged, out where done
  if (child.status == 0) return fs::exists(scratch / "out/results.json") && entries == 3 ? "" : "no whole result";
  if (said.find("error: ") == std::string::npos) return "no message";
  return entries == 2 ? "" : "something left behind";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: mutate_clips GLIDELAB RUNS [SEED] [--command]\n");
    return 2;
  }
  const std::string program = argv[1];
  const long runs = std::strtol(argv[2], nullptr, 10);
  const bool command = std::string_view(argv[argc - 1]) == "--command";
  const auto seed = static_cast<std::uint64_t>(argc > 3 && argv[3][0] != '-' ? std::strtoull(argv[3], nullptr, 10) : 1);
  if (fs::is_directory("/dev/shm")) ::setenv("TMPDIR", "/dev/shm", 0);
  const base::TemporaryFolder place("damage");
  const std::vector<std::string> codecs = {"magicyuv", "ffv1", "raw", "mjpeg", "h264", "png"};
  for (const std::string& codec : codecs) {
    for (const int width_px : {kWidthPx, kScaledWidthPx}) {
      const fs::path file = place / fmt::format("{}-{}.toml", codec, width_px);
      base::write_file(file, scenario(codec, width_px));
      const Child child = in_child(place / "log", [&] {
        return run_program({program, "render", file.string(), "-q", "-o", (place / file.stem()).string()});
      });
      if (child.status != 0) {
        std::fprintf(stderr, "cannot be rendered: %s\n", base::read_file(place / "log").c_str());
        return 1;
      }
    }
  }
  for (const std::string& codec : codecs) {
    take_scale(place / fmt::format("{}-{}", codec, kScaledWidthPx), kScaledWidthPx);
    for (const int width_px : {kWidthPx, kScaledWidthPx}) {
      const fs::path folder = place / fmt::format("{}-{}", codec, width_px);
      if (in_child(place / "log", [&] { return analyse(folder); }).status == 0) continue;
      std::fprintf(stderr, "undamaged, and refused: %s\n", base::read_file(place / "log").c_str());
      return 1;
    }
  }
  std::map<int, long> outcomes;
  long found = 0, most_kilobytes = 0;
  const fs::path scratch = place / "run";
  for (long run = 0; run < runs; ++run) {
    fuzz::Random random(seed * 1'000'003u + static_cast<std::uint64_t>(run));
    const std::string codec = codecs[fuzz::below(random, codecs.size())];
    const bool calibrated = fuzz::below(random, kCalibrated) == 0;
    const fs::path whole = place / fmt::format("{}-{}", codec, calibrated ? kWidthPx : kScaledWidthPx);
    const fs::path other = place / fmt::format("{}-{}", codec, calibrated ? kScaledWidthPx : kWidthPx);
    std::vector<fs::path> files = files_of(whole);
    if (calibrated) {  // half of the damage to what moves, half to what does not
      const bool clip = fuzz::below(random, 2) == 0;
      std::erase_if(files, [&](const fs::path& file) { return (*file.begin() == "clips") != clip; });
    }
    const fs::path file = files[fuzz::below(random, files.size())];
    const std::string kind = fuzz::kDamages[fuzz::below(random, fuzz::kDamages.size())];
    fs::remove_all(scratch);
    fs::create_directories(scratch);
    fs::copy(whole, scratch / "damaged", fs::copy_options::recursive);
    const std::string of_other =
        base::read_file(fs::exists(other / file) ? other / file : other / *files_of(other).begin());
    base::write_file(
        scratch / "damaged" / file,
        fuzz::below(random, 12) == 0 ? of_other : fuzz::damaged(base::read_file(whole / file), kind, of_other, random));
    const Child child = in_child(scratch / "log", [&] {
      return command ? run_program({program, "analyze", (scratch / "damaged").string(), "-q", "--jobs", "1", "-o",
                                    (scratch / "out").string()})
                     : analyse(scratch / "damaged");
    });
    ++outcomes[child.status];
    most_kilobytes = std::max(most_kilobytes, child.kilobytes);
    std::string wrong = child.status > 1 ? fmt::format("status {}", child.status) : "";
    if (wrong.empty() && child.kilobytes > kMostKilobytes) wrong = fmt::format("{} KiB", child.kilobytes);
    if (wrong.empty() && command) wrong = wrong_with_command(child, scratch);
    if (wrong.empty()) continue;
    ++found;
    const fs::path kept = fs::current_path() / fmt::format("damaged-{}-{}", seed, run);
    fs::remove_all(kept);
    fs::copy(scratch / "damaged", kept, fs::copy_options::recursive);
    std::printf("run %ld: %s of %s in %s: %s; kept as %s\n%s\n", run, kind.c_str(), file.c_str(), codec.c_str(),
                wrong.c_str(), kept.c_str(), base::read_file(scratch / "log").substr(0, 1000).c_str());
    std::fflush(stdout);
  }
  for (const auto& [status, count] : outcomes) std::printf("status %d: %ld runs\n", status, count);
  std::printf("%ld runs, %ld findings, at most %ld MiB\n", runs, found, most_kilobytes / 1024);
  return found == 0 ? 0 : 1;
}
