/// What every command takes, and how a command speaks: files, tables and JSON.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/errors.h"

namespace CLI {
class App;
}  // namespace CLI

namespace glidelab::app {

/// Wrong words on the command line that show only after it was read (exit status 2).
class CommandLineError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Does `work`, which looks at nothing but words of the command line: its InputError is a CommandLineError.
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
void add_common_options(CLI::App& command, CommonOptions& options, const std::string& default_out,
                        const std::string& seed_help);

/// --out, or glidelab-out/<command>-<name of input>; absolute, links resolved, no trailing slash.
std::filesystem::path named_folder(const CommonOptions& options, std::string_view command,
                                   const std::filesystem::path& input);

/// The same, for results. CommandLineError where it holds a recording (experiment.toml, characterize.toml): results do
/// not go among what they are made of. A folder inside it may take them.
std::filesystem::path output_folder(const CommonOptions& options, std::string_view command,
                                    const std::filesystem::path& input);

/// "name.truth" beside "name".
std::filesystem::path truth_beside(const std::filesystem::path& experiment);

/// InputError where the experiment folder or its truth hold anything that `render` did not make or that was changed
/// since (base/files/made_files.h): those two are replaced as a whole, and nobody's own files may go with them.
void check_replaceable(const std::filesystem::path& experiment, const std::filesystem::path& truth);

/// InputError where the file `option` names exists and does not begin with `head`, as what is written there would:
/// somebody else's file is not replaced.
void check_own_file(const std::filesystem::path& file, const std::string& option, std::string_view head);

/// EnvironmentError where the folder exists and nothing can be written into it, or where it is a mount point: results
/// are made beside it and renamed, which works within one file system only.
void check_writable(const std::filesystem::path& folder);

/// The same of a file that is written beside its final name: its folder is there, and can be written into.
void check_file_writable(const std::filesystem::path& file);

/// For CLI11, which takes -1 for the largest unsigned number: why the text is none; empty where it is one.
std::string check_whole_number(const std::string& text);

/// Writes a file beside its final name and renames it: what stood there stays where that fails.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// For CLI11, whose own checks take "nan": why the text is no finite number above 0; empty where it is one.
std::string check_above_0(const std::string& text);

/// For CLI11: why the text is no finite number of metres above 0 that a position's noise can be; empty where it is one.
std::string check_noise_m(const std::string& text);

/// Writes to standard output and flushes it; EnvironmentError where that fails.
void print_result(std::string_view text);

/// One line on standard error, unless --quiet.
void say(const CommonOptions& options, std::string_view line);

}  // namespace glidelab::app
