#include "tests/app/run_process.h"

#include <fcntl.h>
#include <grp.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

#include "base/files/file_io.h"
#include "test_paths.h"

namespace glidelab::tests {
namespace fs = std::filesystem;

Process::Process(std::vector<std::string> arguments, const fs::path& working_dir, User user) {
  constexpr uid_t kNobody = 65534;
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const std::string out = (folder_ / "out").string();
  const std::string err = (folder_ / "err").string();
  for (const std::string& file : {out, err}) base::write_file(file, "");  // a child may be killed before it opens them
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ == 0) {  // only async-signal-safe calls from here to exec
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ::signal(SIGINT, SIG_DFL);
    ::signal(SIGTERM, SIG_DFL);
    if (!working_dir.empty() && ::chdir(working_dir.c_str()) != 0) ::_exit(126);
    if (user == User::nobody && (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) {
      ::_exit(126);
    }
    ::execvp(pointers[0], pointers.data());
    ::_exit(127);
  }
}

Process::~Process() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, &wait_status_, 0);
  }
}

void Process::send(int signal) const {
  if (pid_ > 0) ::kill(pid_, signal);
}

bool Process::running() {
  if (pid_ <= 0) return false;
  if (::waitpid(pid_, &wait_status_, WNOHANG) == 0) return true;
  pid_ = -1;
  return false;
}

ProcessResult Process::wait() {
  if (pid_ > 0) ::waitpid(pid_, &wait_status_, 0);
  pid_ = -1;
  ProcessResult result;
  result.status = WIFEXITED(wait_status_) ? WEXITSTATUS(wait_status_) : 1000 + WTERMSIG(wait_status_);
  result.out = base::read_file(folder_ / "out");
  result.err = base::read_file(folder_ / "err");
  return result;
}

ProcessResult run(std::vector<std::string> arguments, const fs::path& working_dir, User user) {
  return Process(std::move(arguments), working_dir, user).wait();
}

ProcessResult glidelab(std::vector<std::string> arguments, const fs::path& working_dir) {
  arguments.insert(arguments.begin(), tests::kBinary);
  return run(std::move(arguments), working_dir);
}

}  // namespace glidelab::tests
