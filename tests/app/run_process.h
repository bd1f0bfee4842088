/// Runs a program as a child process, for tests of what a user of the shell sees.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/file_io.h"

namespace glidelab::tests {

struct ProcessResult {
  int status = -1;  ///< exit status, or 1000 + signal
  std::string out;
  std::string err;
};

/// Whom a child runs as: who runs the test, or nobody (65534), whom permissions hold back, as only root can ask for.
enum class User { same, nobody };

/// A child that runs until it is waited for. Both outputs go to files in a folder of its own.
class Process {
 public:
  /// The first argument is the program, looked up in PATH. `working_dir` empty: the test's own.
  explicit Process(std::vector<std::string> arguments, const std::filesystem::path& working_dir = {},
                   User user = User::same);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  void send(int signal) const;
  bool running();
  ProcessResult wait();

 private:
  pid_t pid_ = -1;
  int wait_status_ = 0;
  base::TemporaryFolder folder_{"process"};
};

ProcessResult run(std::vector<std::string> arguments, const std::filesystem::path& working_dir = {},
                  User user = User::same);

/// The program under test with these arguments.
ProcessResult glidelab(std::vector<std::string> arguments, const std::filesystem::path& working_dir = {});

}  // namespace glidelab::tests
