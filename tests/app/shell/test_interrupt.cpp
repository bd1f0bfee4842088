#include "app/shell/run_control.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "app/shell/cli.h"
#include "base/files/file_io.h"
#include "tests/app/command_names.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

/// Sends itself SIGTERM twice, so far apart, and then ends by itself.
void work_on(unsigned apart_s) {
  ::raise(SIGTERM);
  for (unsigned left = apart_s; left > 0;) left = ::sleep(left);
  ::raise(SIGTERM);
  ::_exit(app::interrupted() ? 7 : 8);
}

/// How a process ends that never looks at the flag; `keeps`: it has said that it keeps what it has finished.
int status_of(unsigned apart_s, bool keeps) {
  const pid_t child = ::fork();
  if (child == 0) {
    app::catch_interrupts();
    if (keeps) app::keep_on_interrupt([&] { work_on(apart_s); }, [] { return std::string(); });
    work_on(apart_s);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Exit status of the program where it is sent SIGTERM before its command begins, run in `folder`; what it said is in
/// the file "said" there.
int status_when_interrupted(const std::filesystem::path& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "glidelab");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  const pid_t child = ::fork();
  if (child == 0) {
    if (::chdir(folder.c_str()) != 0) ::_exit(126);
    ::dup2(::open("said", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    app::catch_interrupts();
    ::raise(SIGTERM);
    ::_exit(app::run(static_cast<int>(pointers.size()), pointers.data()));
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

}  // namespace

TEST_CASE(
    "every command that is ended before its first line of progress says so, with status 130, and writes nothing") {
  std::vector<std::vector<std::string>> commands = {{"diagnose", "--plan", "--noise-m", "1e-5", "a.toml"},
                                                    {"--version"}};
  for (const std::string& name : tests::kCommands) {
    std::vector<std::string> command = {name};
    if (name == "challenge") command.emplace_back("make");
    if (name != "pattern" && name != "explore" && name != "blind") command.emplace_back("nothing.toml");
    if (name == "require") command.insert(command.end(), {"--target", "mu=0.001"});
    if (name == "blind") command.insert(command.end(), {"--cases", "1", "--seed", "1"});
    commands.push_back(std::move(command));
  }
  for (const std::vector<std::string>& command : commands) {
    const tests::TempDir dir;
    CAPTURE(command);
    CHECK(status_when_interrupted(dir.path(), command) == 130);
    CHECK(base::read_file(dir / "said") == "glidelab: error: interrupted; nothing was written\n");
    std::filesystem::remove(dir / "said");
    CHECK(std::filesystem::is_empty(dir.path()));
  }
}

TEST_CASE(
    "out of memory where no exception may pass is reported and leaves nothing, and other exceptions end as ever") {
  // Not a TempDir: a child that is ended removes the temporary folders that it knows, its parent's too.
  std::string made = (std::filesystem::temp_directory_path() / "glidelab-lost-XXXXXX").string();
  REQUIRE(::mkdtemp(made.data()) != nullptr);
  const std::filesystem::path dir = made;
  const auto ended = [&](const std::function<void()>& fails) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::signal(SIGABRT, SIG_DFL);  // Catch2 reports it otherwise
      ::dup2(::open((dir / "said").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
      app::report_lost_memory(3);
      const base::StagedOutput staged(dir / "results");
      base::write_file(staged.dir() / "half", "half");
      fails();
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  };
  const std::function<void()> no_memory = [] { throw std::bad_alloc(); };
  const auto may_not_fail = [&]() noexcept { no_memory(); };  // the compiler ends it in either of two ways
  const std::vector<std::function<void()>> in_vain = {may_not_fail, [&] { std::thread(no_memory).join(); }};
  for (const std::function<void()>& fails : in_vain) {
    CHECK(ended(fails) == 3);
    CHECK_THAT(base::read_file(dir / "said"), Catch::Matchers::Matches("glidelab: error: .*out of memory\n"));
    std::filesystem::remove(dir / "said");
    CHECK(std::filesystem::is_empty(dir));
  }
  CHECK(ended([] { std::thread([] { throw std::runtime_error("another"); }).join(); }) == 1000 + SIGABRT);
  std::filesystem::remove_all(dir);
}

TEST_CASE("what does not look at the first signal is ended within a second") {
  CHECK(status_of(0, false) == 7);
  CHECK(status_of(2, false) == app::kInterruptedStatus);
}

TEST_CASE("a second signal ends what keeps what it has finished, unless both come together") {
  CHECK(status_of(0, true) == 7);
  CHECK(status_of(3, true) == 128 + SIGTERM);
}
