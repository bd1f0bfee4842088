#include "base/files/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <iterator>
#include <thread>

#include "base/errors.h"

namespace glidelab::base {
namespace {

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  std::transform(texts.begin(), texts.end(), std::back_inserter(list), [](std::string& text) { return text.data(); });
  list.push_back(nullptr);
  return list;
}

/// The child's status. Once `stop` says so its group is asked to end, and is ended where it does not.
int waited_for(pid_t child, const std::string& program, const std::function<bool()>& stop) {
  constexpr auto kLook = std::chrono::milliseconds(20);
  constexpr int kPatience = 25;  // looks
  int status = 0, asked = 0;
  while (true) {
    const pid_t ended = ::waitpid(child, &status, stop ? WNOHANG : 0);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) {
      throw EnvironmentError(fmt::format("{}: waiting for it: {}", program, std::strerror(errno)));
    }
    if (!stop) continue;
    if (stop()) {
      if (asked == 0) ::kill(-child, SIGTERM);
      if (asked++ == kPatience) ::kill(-child, SIGKILL);
    }
    std::this_thread::sleep_for(kLook);
  }
}

}  // namespace

int run_program(const std::string& program, std::vector<std::string> arguments, const std::filesystem::path& log,
                std::vector<std::string> environment, const std::string& hint, const std::function<bool()>& stop) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  arguments.insert(arguments.begin(), program);
  const bool own = environment.empty();
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), &actions, &attributes, pointers(arguments).data(),
                                   own ? environ : pointers(environment).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw EnvironmentError(fmt::format("{} cannot be started: {}{}", program, std::strerror(error), hint));
  return waited_for(child, program, stop);
}

std::string how_it_failed(int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                             : fmt::format("failed with status {}", WEXITSTATUS(status));
}

}  // namespace glidelab::base
