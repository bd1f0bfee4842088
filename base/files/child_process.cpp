#include "base/files/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <sstream>
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

/// Waits for the child and returns its status. Once `stop` returns true, its group is asked to end, and killed if it
/// does not.
int waited_for(pid_t child, const std::string& program, const std::function<bool()>& stop) {
  constexpr auto kPollInterval = std::chrono::milliseconds(20);
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
    std::this_thread::sleep_for(kPollInterval);
  }
}

/// Starts the program as the header says and returns its process number.
pid_t spawned(const std::string& program, std::vector<std::string> arguments, const std::filesystem::path& log,
              std::vector<std::string> environment, const std::string& hint) {
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
  return child;
}

/// What is wanted, or less where this program itself may not have as much (ulimit): nobody may raise a hard limit.
template <typename Resource>
std::uint64_t within(Resource resource, std::uint64_t wanted) {
  rlimit own = {};
  if (::getrlimit(resource, &own) != 0 || own.rlim_max == RLIM_INFINITY) return wanted;
  return std::min<std::uint64_t>(wanted, own.rlim_max);
}

/// util-linux's prlimit starts the program under its limits, so that they hold from its first instruction.
std::vector<std::string> under_limits(const std::string& program, const ProgramLimits& limits) {
  const double cores = std::max(1U, std::thread::hardware_concurrency());
  const auto cpu_s = static_cast<std::uint64_t>(std::ceil(limits.wall_s * cores)) + 1;
  return {fmt::format("--as={}", within(RLIMIT_AS, limits.memory_bytes)),
          fmt::format("--fsize={}", within(RLIMIT_FSIZE, limits.memory_bytes)),
          fmt::format("--cpu={}", within(RLIMIT_CPU, cpu_s)),
          "--core=0",
          "--",
          program};
}

/// Whether the child has ended. It is not reaped, so that its number remains that of its group.
bool has_ended(pid_t child, const std::string& program) {
  siginfo_t info = {};
  if (::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0 && errno != EINTR) {
    throw EnvironmentError(fmt::format("{}: waiting for it: {}", program, std::strerror(errno)));
  }
  return info.si_pid == child;
}

}  // namespace

int run_program(const std::string& program, std::vector<std::string> arguments, const std::filesystem::path& log,
                std::vector<std::string> environment, const std::string& hint, const std::function<bool()>& stop) {
  return waited_for(spawned(program, std::move(arguments), log, std::move(environment), hint), program, stop);
}

ProgramEnd run_limited(const std::string& program, std::vector<std::string> arguments, const std::filesystem::path& log,
                       const ProgramLimits& limits, const std::function<bool()>& stop) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  constexpr Seconds kPatience(0.5), kShortestLook(0.001), kLongestLook(0.02);
  const auto start = Clock::now();
  const std::vector<std::string> limited = under_limits(program, limits);
  arguments.insert(arguments.begin(), limited.begin(), limited.end());
  const pid_t child = spawned("prlimit", std::move(arguments), log, {}, " (package util-linux)");
  ProgramEnd end;
  Clock::time_point asked;
  while (!has_ended(child, program)) {
    const auto now = Clock::now();
    if (end.by == ProgramEndedBy::itself) {
      if (stop && stop()) end.by = ProgramEndedBy::request;
      if (Seconds(now - start).count() > limits.wall_s) end.by = ProgramEndedBy::time;
      if (end.by != ProgramEndedBy::itself) {
        ::kill(-child, SIGTERM);
        asked = now;
      }
    } else if (now - asked > kPatience) {
      ::kill(-child, SIGKILL);
    }
    // Polls a short program often and a long one rarely.
    std::this_thread::sleep_for(std::clamp(Seconds(now - start) / 20.0, kShortestLook, kLongestLook));
  }
  ::kill(-child, SIGKILL);
  while (::waitpid(child, &end.status, 0) < 0 && errno == EINTR) {
  }
  end.wall_s = Seconds(Clock::now() - start).count();
  return end;
}

bool is_program(const std::string& name) {
  const auto runs = [](const std::filesystem::path& file) {
    return std::filesystem::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0;
  };
  if (name.find('/') != std::string::npos) return runs(name);
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/bin:/usr/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!name.empty() && runs(std::filesystem::path(folder.empty() ? "." : folder) / name)) return true;
  }
  return false;
}

std::string how_it_failed(int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                             : fmt::format("failed with status {}", WEXITSTATUS(status));
}

}  // namespace glidelab::base
