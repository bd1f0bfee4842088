/// Another program, run to its end.
///
/// Standard input is closed and both outputs go into a file. The child has a process group of its own, so that an
/// interrupt at the terminal reaches this program alone, which then decides.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace glidelab::base {

/// The status of waitpid. `program` is looked up in PATH if it has no slash; `environment` holds NAME=value; if it
/// is empty, the child gets this program's own. EnvironmentError if it cannot be started; `hint` completes the message.
/// `stop`, if given, is asked every 20 ms; once it returns true, the child's group gets SIGTERM, and SIGKILL half a
/// second later.
int run_program(const std::string& program, std::vector<std::string> arguments, const std::filesystem::path& log,
                std::vector<std::string> environment = {}, const std::string& hint = {},
                const std::function<bool()>& stop = {});

/// "" if it ended with status 0, else how it ended.
std::string how_it_failed(int status);

}  // namespace glidelab::base
