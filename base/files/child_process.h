/// Another program, run to its end.
///
/// Standard input is closed and both outputs go into a file. The child has a process group of its own, so that an
/// interrupt at the terminal reaches this program alone, which then decides.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace glidelab::base {

/// Returns the status of waitpid. `program` is looked up in PATH if it has no slash. `environment` holds NAME=value; if
/// it is empty, the child inherits this program's environment. EnvironmentError if it cannot be started; `hint`
/// completes the message. `stop`, if given, is asked every 20 ms; once it returns true, the child's group gets SIGTERM,
/// and SIGKILL half a second later.
int run_program(const std::string& program, std::vector<std::string> arguments, const std::filesystem::path& log,
                std::vector<std::string> environment = {}, const std::string& hint = {},
                const std::function<bool()>& stop = {});

/// Upper limits on the resources of an outside program. Where this program's own hard limits are lower (ulimit, a batch
/// system), the lower ones apply.
struct ProgramLimits {
  double wall_s = 60.0;
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;  ///< address space of a process, and size of a file it writes
};

enum class ProgramEndedBy { itself, request, time };

struct ProgramEnd {
  int status = 0;  ///< of waitpid
  ProgramEndedBy by = ProgramEndedBy::itself;
  double wall_s = 0.0;
};

/// As run_program(), within limits. Processor time is limited to wall_s on every core; after wall_s the group is ended
/// as by `stop`. Processes that the program leaves behind in its group are ended with it. The limits of memory and
/// processor time are set right after the start (prlimit(2)).
ProgramEnd run_limited(const std::string& program, std::vector<std::string> arguments, const std::filesystem::path& log,
                       const ProgramLimits& limits, const std::function<bool()>& stop = {});

/// Whether run_program() would find the program: an executable file, looked up in PATH if the name has no slash.
bool is_program(const std::string& name);

/// "" if the program ended with status 0, else how it ended.
std::string how_it_failed(int status);

}  // namespace glidelab::base
