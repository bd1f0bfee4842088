#include "app/shell/run_control.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// How a process ends that never looks at the flag and is sent SIGTERM twice, so far apart, and then ends by itself.
int status_of(unsigned apart_s) {
  const pid_t child = ::fork();
  if (child == 0) {
    app::catch_interrupts();
    ::raise(SIGTERM);
    for (unsigned left = apart_s; left > 0;) left = ::sleep(left);
    ::raise(SIGTERM);
    ::_exit(app::interrupted() ? 7 : 8);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("a second signal ends what does not look at the first, unless both come together") {
  CHECK(status_of(0) == 7);
  CHECK(status_of(3) == 128 + SIGTERM);
}
