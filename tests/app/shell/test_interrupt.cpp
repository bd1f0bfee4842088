#include "app/shell/run_control.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.h"

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

}  // namespace

TEST_CASE("what does not look at the first signal is ended within a second") {
  CHECK(status_of(0, false) == 7);
  CHECK(status_of(2, false) == app::kInterruptedStatus);
}

TEST_CASE("a second signal ends what keeps what it has finished, unless both come together") {
  CHECK(status_of(0, true) == 7);
  CHECK(status_of(3, true) == 128 + SIGTERM);
}
