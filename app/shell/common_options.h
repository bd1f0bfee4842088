/// Three groups of options: of every command, of those that take recordings (analyze, check, diagnose, certify), and of
/// those that run an estimator of the user's own; and how a command writes: files, tables and JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "core/experiment/permissions.h"
#include "core/track/bare_track.h"
#include "fit/outside/outside_estimator.h"

namespace CLI {
class App;
}  // namespace CLI

namespace glidelab::app {

/// A mistake on the command line that shows only after parsing (exit status 2).
class CommandLineError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `work`, which depends on the command line alone, and turns its InputError into a CommandLineError.
template <class Work>
auto of_command_line(const Work& work) {
  try {
    return work();
  } catch (const base::InputError& error) {
    throw CommandLineError(error.what());
  }
}

struct CommonOptions {
  std::string out;  ///< empty: the default
  std::optional<std::uint64_t> seed;
  int jobs = 1;
  bool json = false;
  bool quiet = false;
  bool verbose = false;
};

/// Adds --out, --seed, --jobs, --json, --quiet and --verbose. `default_out` and `seed_help` complete their help.
/// Without `seed_help` the command draws no random numbers: --seed is accepted and not listed.
void add_common_options(CLI::App& command, CommonOptions& options, const std::string& default_out,
                        const std::string& seed_help = {});

/// --out, or glidelab-out/<command>-<name of input>; absolute, links resolved, no trailing slash.
std::filesystem::path named_folder(const CommonOptions& options, std::string_view command,
                                   const std::filesystem::path& input);

/// The same, for results. CommandLineError if it holds a recording (experiment.toml, characterize.toml): results
/// are not mixed with their input. A folder inside it is allowed.
std::filesystem::path output_folder(const CommonOptions& options, std::string_view command,
                                    const std::filesystem::path& input);

/// "name.truth" next to "name".
std::filesystem::path truth_beside(const std::filesystem::path& experiment);

/// InputError if the experiment folder or its truth contains anything that `render` did not write or that has since
/// been changed (base/files/file_io.h): the two are replaced as a whole, and no file of the user's own may be lost.
void check_replaceable(const std::filesystem::path& experiment, const std::filesystem::path& truth);

/// InputError if the file that `option` names exists and does not begin with `head`, as this program's file does: a
/// foreign file is not replaced.
void check_own_file(const std::filesystem::path& file, const std::string& option, std::string_view head);

/// EnvironmentError if the folder exists and cannot be written into, or if it is a mount point: results are written
/// next to it and renamed, which works within one file system only.
void check_writable(const std::filesystem::path& folder);

/// The same for a file that is written next to its final name: its folder must exist and be writable.
void check_file_writable(const std::filesystem::path& file);

/// For CLI11, which reads -1 as the largest unsigned number: why the text is not a whole number; empty if it is one.
std::string check_whole_number(const std::string& text);

/// Writes a file next to its final name and renames it: if that fails, the old file stays.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// For CLI11, whose own checks accept "nan": why the text is not a finite number above 0; empty if it is one.
std::string check_above_0(const std::string& text);

/// For CLI11: why the text is not a plausible position noise in metres; empty if it is one.
std::string check_noise_m(const std::string& text);

/// Writes to standard output and flushes it; EnvironmentError if that fails.
void print_result(std::string_view text);

/// The same for sentences and tables: on a terminal the sentences are wrapped to the width of the window. JSON stays,
/// and so does what is written to a file or a pipe, where the answer is the whole first line.
void print_answer(std::string_view text);

/// One line on standard error, unless --quiet.
void say(const CommonOptions& options, std::string_view line);

/// Adds --allow-outside and --max-megapixels, which set `permitted`.
void add_permissions(CLI::App& command, core::Permissions& permitted);

/// Adds --max-megapixels alone.
void add_max_megapixels(CLI::App& command, std::size_t& most_pixels);

/// InputError if one of these is a scenario or a sweep, which contain no recording.
void refuse_scenarios(const std::vector<std::string>& inputs);

/// "; use a decimal point: 0.335" for "0,335"; empty for any other text.
std::string decimal_point_for(const std::string& text);

/// Options of the commands that accept a track file as well as experiment folders (analyze, check, diagnose, certify):
/// what the file does not state.
///
/// --column, --mass, --incline, --incline-sd, --gravity, --gravity-sd, --runs, --masses, and, for folders,
/// --allow-outside and --max-megapixels.
void add_bare_options(CLI::App& command, core::TrackFileOptions& options);

/// Options for files have no meaning for folders, whose experiment.toml states the same: InputError if an input is a
/// folder and one of them is given, and for --masses with --mass.
void check_bare_options(const core::TrackFileOptions& options, const std::vector<std::string>& inputs);

/// The options with the masses of several files (core/track/bare_track.h).
core::TrackFileOptions with_masses(const core::TrackFileOptions& options, const std::vector<std::string>& inputs);

/// Options of the commands that judge an outside estimator (fit/outside/outside_estimator.h).
struct OutsideOptions {
  std::string command;
  std::string name;  ///< empty: from the command
  double seconds = 60.0;
  double megabytes = 4096.0;

  /// Empty without a command; CommandLineError if it is not valid. An interrupt ends the estimator's program.
  std::optional<fit::OutsideEstimator> estimator() const;
};

/// Adds --estimator-command, --estimator-name, --estimator-seconds and --estimator-megabytes.
void add_outside_options(CLI::App& command, OutsideOptions& options,
                         const std::string& use = "Also judge an estimator of your own");

/// "40 s", "12 min", "3.5 h", "4 days".
std::string duration_text(double seconds);

}  // namespace glidelab::app
