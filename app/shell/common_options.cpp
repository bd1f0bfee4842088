#include "app/shell/common_options.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <CLI/App.hpp>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <thread>
#include <vector>

#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/wrapped_text.h"
#include "base/toml/strict_toml.h"
#include "fit/estimators.h"

namespace glidelab::app {

namespace {

namespace fs = std::filesystem;

constexpr int kMostJobs = 1024;

int number_of_cores() {
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, static_cast<unsigned>(kMostJobs)));
}

bool holds_files(const fs::path& folder) {
  return fs::is_directory(folder) && !fs::is_empty(folder);
}

/// "scenarios/level.toml" gives "level", "data/run-1/" gives "run-1", "." the name of the working folder.
std::string name_of(const fs::path& input) {
  const fs::path whole = fs::absolute(input).lexically_normal();
  const fs::path last = whole.has_filename() ? whole : whole.parent_path();
  return (last.extension() == ".toml" ? last.stem() : last.filename()).string();
}

}  // namespace

void add_common_options(CLI::App& command, CommonOptions& options, const std::string& default_out,
                        const std::string& seed_help) {
  options.jobs = number_of_cores();
  command.set_help_flag("-h,--help", "Show this help");
  command.add_option("-o,--out", options.out, "Folder for the results; default: " + default_out)
      ->type_name("DIR")
      ->check([](const std::string& text) {
        if (text.empty()) return std::string("the name is empty");
        return text.front() == '-' ? fmt::format("found \"{}\", expected the name of a folder", text) : std::string();
      });
  CLI::Option* seed = command.add_option("--seed", options.seed, seed_help)->type_name("N")->check(check_whole_number);
  if (seed_help.empty()) seed->group("");
  command
      .add_option("--jobs", options.jobs,
                  fmt::format("Number of threads; default: the number of cores ({})", options.jobs))
      ->type_name("N")
      ->check(CLI::Range(1, kMostJobs));
  command.add_flag("--json", options.json, "Print the result on standard output as one JSON object");
  CLI::Option* quiet =
      command.add_flag("-q,--quiet", options.quiet, "Print no progress, and no messages except errors");
  command.add_flag("-v,--verbose", options.verbose, "Print how long each stage took")->excludes(quiet);
}

fs::path named_folder(const CommonOptions& options, std::string_view command, const fs::path& input) {
  const fs::path wanted = options.out.empty() ? fs::path("glidelab-out") / fmt::format("{}-{}", command, name_of(input))
                                              : fs::path(options.out);
  std::error_code error;  // a path that cannot be resolved (a file in the way) fails when the folder is made
  const fs::path resolved = fs::weakly_canonical(fs::absolute(wanted), error);
  const fs::path folder = error ? fs::absolute(wanted).lexically_normal() : resolved;
  return folder.has_filename() ? folder : folder.parent_path();
}

fs::path output_folder(const CommonOptions& options, std::string_view command, const fs::path& input) {
  const fs::path folder = named_folder(options, command, input);
  for (const char* const recording : {"experiment.toml", "characterize.toml"}) {
    std::error_code ignored;  // a folder that cannot be read fails when it is written
    if (!fs::exists(folder / recording, ignored)) continue;
    throw CommandLineError(base::describe({folder.string(), 0, "--out", fmt::format("a recording ({})", recording),
                                           "another folder, or a new one inside it"}));
  }
  return folder;
}

fs::path truth_beside(const fs::path& experiment) {
  return experiment.parent_path() / (experiment.filename().string() + ".truth");
}

void check_replaceable(const fs::path& experiment, const fs::path& truth) {
  for (const fs::path& folder : {experiment, truth}) {
    if (!holds_files(folder)) continue;
    const bool made = fs::exists(folder / base::kMadeList);
    const std::vector<base::OwnFile> own = base::own_files(folder);
    if (made && own.empty()) continue;
    constexpr std::size_t kMost = 4;
    std::string names;
    for (std::size_t i = 0; i < std::min(own.size(), kMost); ++i) {
      names += fmt::format("{}{}{}", i == 0 ? "" : ", ", own[i].name.string(), own[i].changed ? " (changed)" : "");
    }
    if (own.size() > kMost) names += fmt::format(" and {} more", own.size() - kMost);
    throw base::InputError(
        base::Issue{folder.string(), 0, "--out",
                    "a folder with files that render did not make, or that were changed since: " + names,
                    "a new folder, an empty one, or one that holds only what render made; nothing was touched"});
  }
}

void check_own_file(const fs::path& file, const std::string& option, std::string_view head) {
  if (!fs::exists(file) || fs::is_empty(file) || base::read_file(file).starts_with(head)) return;
  throw base::InputError(base::Issue{file.string(), 0, option, "a file that this option did not write",
                                     "a new name, or what it wrote before"});
}

void check_writable(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder, error) && ::access(folder.c_str(), W_OK | X_OK) != 0) {
    base::throw_system_error(folder.string(), "output folder cannot be written", errno);
  }
  struct stat own = {};
  struct stat parent = {};
  if (::stat(folder.c_str(), &own) == 0 && ::stat(folder.parent_path().c_str(), &parent) == 0 &&
      own.st_dev != parent.st_dev) {
    throw base::EnvironmentError(fmt::format(
        "{}: is a file system of its own, into which results cannot be moved in one step; give a folder inside it",
        folder.string()));
  }
}

void check_file_writable(const fs::path& file) {
  const fs::path folder = fs::absolute(file).parent_path();
  std::error_code error;
  if (fs::is_directory(file, error)) base::throw_system_error(file.string(), "cannot be written", EISDIR);
  if (!fs::is_directory(folder, error)) {
    base::throw_system_error(file.string(), "cannot be written", fs::exists(folder, error) ? ENOTDIR : ENOENT);
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) base::throw_system_error(file.string(), "cannot be written", errno);
}

std::string check_whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size()) return {};
  return fmt::format("\"{}\" is not a whole number from 0 to {}", text, std::numeric_limits<std::uint64_t>::max());
}

void write_whole(const fs::path& file, std::string_view text) {
  const fs::path part = file.string() + ".part";
  try {
    base::write_file(part, text);
    fs::rename(part, file);
  } catch (...) {
    std::error_code ignored;  // the error of the file is the one to report
    fs::remove(part, ignored);
    throw;
  }
}

std::string decimal_point_for(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos || text.find_first_not_of("+-0123456789,") != std::string::npos) return {};
  if (text.find(',', comma + 1) != std::string::npos || comma == 0 || comma + 1 == text.size()) return {};
  std::string with_point = text;
  with_point[comma] = '.';
  return "; use a decimal point: " + with_point;
}

std::string check_above_0(const std::string& text) {
  double value = 0.0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0.0) return {};
  return fmt::format("\"{}\" is not a number above 0{}", text, decimal_point_for(text));
}

std::string check_noise_m(const std::string& text) {
  constexpr double kLeast_m = 1e-9, kMost_m = 1.0;
  double value = 0.0;
  if (CLI::detail::lexical_cast(text, value) && value >= kLeast_m && value <= kMost_m) return {};  // false for NaN
  return fmt::format("\"{}\" is not a number of metres from {} to {}", text, kLeast_m, kMost_m);
}

void print_result(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) base::throw_system_error("standard output", "cannot be written", errno);
}

void print_answer(std::string_view text) {
  winsize window{};
  const bool on_terminal = ::isatty(STDOUT_FILENO) == 1 && !text.starts_with('{');
  if (!on_terminal) return print_result(text);
  const bool known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
  print_result(base::prose_wrapped(text, known ? window.ws_col : base::kTerminalWidth));
}

void say(const CommonOptions& options, std::string_view line) {
  if (!options.quiet) fmt::print(stderr, "{}\n", line);
}

namespace {

/// "a scenario", "a sweep", or empty: another file, or one that cannot be read.
std::string sort_of(const std::filesystem::path& path) {
  std::error_code ignored;
  if (path.extension() != ".toml" || path.filename() == "experiment.toml") return {};
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  try {
    const base::TomlFile file = base::TomlFile::parse(base::read_file(path), path.string());
    if (file.root().has("configuration")) return "a scenario";
    return file.root().has("scenario") && file.root().has("vary") ? "a sweep" : "";
  } catch (const base::InputError&) {
    return {};  // reported by the code that reads it
  }
}

}  // namespace

constexpr double kMostMegapixels = 1000.0;  // OpenCV decodes no image of more than 2^30 pixels

void add_permissions(CLI::App& command, core::Permissions& permitted) {
  command.add_flag_callback(
      "--allow-outside", [&permitted] { permitted.outside = core::OutsideFiles::allowed; },
      "Allow absolute names and `..` in experiment.toml, which lead to files outside the folder");
  add_max_megapixels(command, permitted.most_pixels);
}

void add_max_megapixels(CLI::App& command, std::size_t& most_pixels) {
  command
      .add_option_function<double>(
          "--max-megapixels",
          [&most_pixels](double megapixels) { most_pixels = static_cast<std::size_t>(std::llround(1e6 * megapixels)); },
          fmt::format("The largest image or frame that is read, in millions of pixels; default: {:g}",
                      1e-6 * static_cast<double>(most_pixels)))
      ->type_name("NUMBER")
      ->check(check_above_0)
      ->check(CLI::Range(0.0, kMostMegapixels));
}

void refuse_scenarios(const std::vector<std::string>& inputs) {
  std::vector<base::Issue> issues;
  for (const std::string& input : inputs) {
    const std::string sort = sort_of(input);
    if (sort.empty()) continue;
    issues.push_back({input, 0, "", sort,
                      sort == "a sweep" ? "a recording; glidelab sweep and require take a sweep"
                                        : "a recording; glidelab render makes one of a scenario"});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
}

namespace {

std::string check_incline(const std::string& text) {
  constexpr double kSteepest_deg = 90.0;  // a fall
  double value_deg = 0.0;
  if (CLI::detail::lexical_cast(text, value_deg) && std::abs(value_deg) <= kSteepest_deg) return {};  // false for NaN
  return fmt::format("\"{0}\" is not a number of degrees from -{1} to {1}{2}", text, kSteepest_deg,
                     decimal_point_for(text));
}

std::string check_recorder(const std::string& text) {
  if (core::recorder_named(text) != core::RecordedBy::unstated) return {};
  return fmt::format("\"{}\" is neither sensor nor camera", text);
}

}  // namespace

void add_bare_options(CLI::App& command, core::TrackFileOptions& options) {
  CLI::Option* column =
      command
          .add_option(
              "--column", options.column,
              "For a file: the column that holds x, by header or number; default: found by its header. For a Tracker "
              "project: the point mass; default: the only one")
          ->type_name("NAME|NUMBER");
  CLI::Option* mass = command.add_option("--mass", options.mass_kg, "For a file: mass of the glider in kilograms")
                          ->type_name("KG")
                          ->check(check_above_0);
  CLI::Option* incline =
      command.add_option("--incline", options.incline_deg, "For a file: stated inclination in degrees")
          ->type_name("DEG")
          ->check(check_incline);
  command
      .add_option("--incline-sd", options.incline_sd_deg,
                  "With --incline: its standard deviation in degrees; motion in one direction then gives mu")
      ->type_name("DEG")
      ->check(check_above_0)
      ->needs(incline);
  CLI::Option* gravity = command
                             .add_option("--gravity", options.gravity_m_s2,
                                         "For a file: local gravity in m/s², taken as known to its last digit; "
                                         "default: 9.80665 ± 0.015")
                             ->type_name("M_S2")
                             ->check(check_above_0);
  command.add_option("--gravity-sd", options.gravity_sd_m_s2, "With --gravity: its standard deviation in m/s²")
      ->type_name("M_S2")
      ->check(CLI::Range(0.0, 1.0))
      ->needs(gravity);
  CLI::Option* runs =
      command.add_option("--runs", options.runs,
                         "For a file with several runs or masses: which of them become clips, \"all\" or "
                         "their numbers, such as 1,3");
  runs->type_name("all|N,N")->excludes(column);
  command
      .add_option("--masses", options.masses_kg,
                  "For several files: the mass of each in kilograms, such as 0.0088,0.0079; with --runs, of each run")
      ->type_name("KG,KG")
      ->delimiter(',')
      ->check(check_above_0)
      ->excludes(mass);
  command
      .add_option("--frame-rate", options.frame_rate_hz,
                  "For a file that counts frames in place of times: frames a second")
      ->type_name("HZ")
      ->check(check_above_0);
  command
      .add_option("--px-per-m", options.px_per_m,
                  "For a file of positions in pixels, as DeepLabCut, SLEAP or a script write them: pixels in a metre")
      ->type_name("NUMBER")
      ->check(check_above_0);
  command
      .add_option_function<std::string>(
          "--recorded-by", [&options](const std::string& by) { options.recorded_by = core::recorder_named(by); },
          "For a file: what measured the positions; default: as the table's header says, if it does. A sensor's "
          "positions have none of the errors that only a camera makes")
      ->type_name("sensor|camera")
      ->check(check_recorder);
  add_permissions(command, options.permitted);
}

void check_bare_options(const core::TrackFileOptions& options, const std::vector<std::string>& inputs) {
  const bool states = options.mass_kg || options.incline_deg || options.gravity_m_s2;
  const bool has_masses = !options.masses_kg.empty() || !options.mass_of_file.empty();
  const bool has_recorder = options.recorded_by != core::RecordedBy::unstated;
  const bool of_images = options.frame_rate_hz || options.px_per_m;
  if (options.column.empty() && !states && options.runs.empty() && !has_masses && !has_recorder && !of_images) return;
  for (const std::string& input : inputs) {
    std::error_code unreadable;
    const bool readable = std::filesystem::exists(input, unreadable);
    if (!readable || core::is_bare_track(input)) continue;  // the reader says that there is no such file
    throw base::InputError(base::Issue{
        input, 0,
        "--column, --mass, --incline, --incline-sd, --gravity, --gravity-sd, --runs, --masses, --frame-rate, "
        "--px-per-m, --recorded-by",
        "not a file with a track",
        "a file; for a folder, experiment.toml states column, mass_kg, incline_deg, gravity_m_s2, [camera] "
        "frame_rate_hz, [scale] px_per_m and recorded_by"});
  }
}

core::TrackFileOptions with_masses(const core::TrackFileOptions& options, const std::vector<std::string>& inputs) {
  return core::masses_of_files(options, {inputs.begin(), inputs.end()});
}

namespace {

constexpr double kMegabyte = 1048576.0;  // bytes
constexpr double kMostMegabytes = 1e9;   // no computer has as much

}  // namespace

std::optional<fit::OutsideEstimator> OutsideOptions::estimator() const {
  if (command.empty()) return std::nullopt;
  return of_command_line([&] {
    fit::OutsideEstimator made = fit::outside_estimator(command, name);
    made.limits.wall_s = seconds;
    made.limits.memory_bytes = static_cast<std::uint64_t>(megabytes * kMegabyte);
    made.stop = interrupted;
    return made;
  });
}

void add_outside_options(CLI::App& command, OutsideOptions& options, const std::string& use) {
  CLI::Option* judged = command
                            .add_option("--estimator-command", options.command,
                                        use +
                                            ": a program that reads the experiment folder {folder} "
                                            "and writes {out}/results.json (docs/reference/own-estimator.md)")
                            ->type_name("COMMAND");
  command
      .add_option("--estimator-name", options.name, "Its name in the results; default: the name of the program file")
      ->type_name("NAME")
      ->needs(judged);
  command.add_option("--estimator-seconds", options.seconds, "Longest time that one of its runs may take")
      ->type_name("SECONDS")
      ->check(check_above_0)
      ->needs(judged)
      ->capture_default_str();
  command.add_option("--estimator-megabytes", options.megabytes, "Most memory that one of its processes may use")
      ->type_name("MB")
      ->check(check_above_0)
      ->check(CLI::Range(0.0, kMostMegabytes))
      ->needs(judged)
      ->capture_default_str();
}

std::string duration_text(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.2g} s", seconds);
  if (seconds < 5400.0) return fmt::format("{:.0f} min", seconds / 60.0);
  if (seconds < 172800.0) return fmt::format("{:.1f} h", seconds / 3600.0);
  return fmt::format("{:.0f} days", seconds / 86400.0);
}

}  // namespace glidelab::app
